// SPDX-License-Identifier: Apache-2.0
/// Body estimates of a video by another system: SMPL poses of its people in each frame, with the camera that the system
/// assumes. Read by load_estimate.h; EstimateInCamera() brings one person into the camera of a fit.
///
/// Note that `trans` moves the body model's origin, which is not the pelvis about which the root rotates. rest_pelvis
/// is that of the mean shape (MeanPelvis, body/body_landmarks.h), or a track's own.
///
/// Systems differ in that camera: a full-image pinhole of a guessed focal length (WHAM, GVHMR), one of a very long
/// focal length (PHALP), a scale and an offset (VIBE). The image determines the pixel of the pelvis, the pixels per
/// metre there, and the body's rotation relative to its line of sight. These three are preserved when a pose is
/// converted to another camera.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct PersonEstimate {
  std::string name;             ///< as in the file, for example "3"
  std::vector<int> frames;      ///< N, frames of the video, from 0, increasing; in others the person is missing
  RowMatrixXd poses;            ///< N×72 axis-angle of SMPL's 24 joints; the hands are 0 where the system has none
  MatrixX3d trans;              ///< N×3, metres, of the body model in its frame's camera; weak perspective: 0
  std::vector<Camera> cameras;  ///< N: pinhole or weak perspective; image size 0x0 where unknown
  /// N of 21×3, in place of poses (which then has no columns), for systems with points of another body: COCO's 17, left
  /// and right big toe, left and right heel, metres from the mid-hip, in the axes of the frame's camera. `trans` is the
  /// mid-hip.
  std::vector<MatrixX3d> landmarks;
  Eigen::VectorXd betas;  ///< of the system's body, mean over its frames
};

struct BodyEstimate {
  std::string system;                                     ///< "WHAM"
  std::string body;                                       ///< of the betas: "smpl", "smplx" or the name of a track's
  Eigen::Vector3d rest_pelvis = Eigen::Vector3d::Zero();  ///< of that body, metres: the pelvis is at `trans` plus this
  int num_frames = 0;                  ///< of the video, if entry i is frame i; 0: entries have their own frame numbers
  std::vector<PersonEstimate> people;  ///< at least one, each of at least one frame; by falling size and time in view
  bool has_landmarks = false;          ///< points in place of poses; rest_pelvis is 0 and the mid-hip is the pelvis
  /// False for landmarks whose place was not written, nor who they are from frame to frame: trans and cameras hold
  /// nothing until PlaceByDetections().
  bool has_places = true;
};

/// Image evidence of a body: pixel of its pelvis, its size there, and the line of sight.
struct PelvisInImage {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double px_per_metre = 0;                        ///< of lengths parallel to the image
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();  ///< (x/z, y/z) in the estimate's own camera; weak perspective: 0, 0
};

/// Returns that of entry i of a person; nullopt when the pelvis is not in front of the camera.
std::optional<PelvisInImage> PelvisOf(const PersonEstimate& person, size_t i, const Eigen::Vector3d& rest_pelvis);

/// Converts the person to `camera` (pinhole): with the pelvis at pixel p on ray r, s pixels per metre there, and ray r'
/// and focal length f' of `camera`, the pelvis moves to (f'/s)·(r', 1), and the root is rotated by the smallest
/// rotation from r to r'. In the estimate's own camera nothing changes. `num_frames` rows, NaN where the person is
/// missing; timestamps are left empty. `estimate_pelvis` is the pelvis of the estimate's body at rest, `pelvis` that of
/// the body of the returned `trans`. Throws std::invalid_argument for a frame beyond num_frames and a camera that is
/// not a pinhole.
Motion EstimateInCamera(const PersonEstimate& person, const Camera& camera, int num_frames,
                        const Eigen::Vector3d& estimate_pelvis, const Eigen::Vector3d& pelvis);

/// The same for landmarks: T of 21×3 in `camera`'s frame, without rows where the person is missing.
std::vector<MatrixX3d> LandmarksInCamera(const PersonEstimate& person, const Camera& camera, int num_frames);

/// Places landmarks without a place (BodyEstimate::has_places) by the detections of one person, seen with `camera` (a
/// pinhole). In each frame a skeleton L is moved by the t that minimises Σ_k ‖(L_k + t).xy − z r_k‖², over the
/// landmarks detected with a confidence of at least 0.3, r_k their rays (x/z, y/z) and z the depth of L_k + t. Of
/// several skeletons the one is kept whose landmarks lie nearest to their rays, root mean square, if that is within 0.2
/// m; the person of these is the only one left. Throws std::runtime_error beginning with `where` if there is none.
void PlaceByDetections(const KeypointSequence& keypoints, const Camera& camera, const std::string& where,
                       BodyEstimate* estimate);

/// Index of the person who matches these landmarks best: the highest Σ over frames of max(0, 1 − d/reach), with d the
/// distance from the pelvis to the mid-hip (reach 0.35 m at the person's own size) or, where a hip is missing, to the
/// mean of the other landmarks (0.8 m). −1 if nobody is within reach in any frame.
int PersonSeenAs(const BodyEstimate& estimate, const KeypointSequence& keypoints);

}  // namespace bodyloom
