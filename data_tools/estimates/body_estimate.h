// SPDX-License-Identifier: Apache-2.0
/// What another system made of a video: SMPL poses of the people in it, frame by frame, each with the camera in which
/// that system means them. Read by load_estimate.h; EstimateInCamera() brings one person into the camera of a fit.
///
/// Whose pelvis stands where: `trans` moves the body model's origin, which is not the pelvis about which the root
/// turns. rest_pelvis is that of the mean shape (body/mean_pelvis.h), or a track's own.
///
/// Systems differ in that camera: a full-image pinhole of a guessed focal length (WHAM, GVHMR), one of a very long
/// focal length (PHALP), a scale and an offset (VIBE). What they agree on is what the image says: where the pelvis is
/// seen, how many pixels a metre has there, and how the body is turned against its line of sight. These three are kept
/// when a pose moves into another camera.
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
  std::string name;             ///< the file's own, as "3"
  std::vector<int> frames;      ///< N, of the video, from 0, increasing; the others are missing
  RowMatrixXd poses;            ///< N×72 axis-angle of SMPL's 24 joints; the hands are 0 where the system has none
  MatrixX3d trans;              ///< N×3, metres, of the body model in its frame's camera; weak perspective: 0
  std::vector<Camera> cameras;  ///< N: pinhole or weak perspective; of images of 0x0 where a file does not say
  /// N of 21×3, in place of poses (which then has no columns), where a system gives points of another body: COCO's 17,
  /// left and right big toe, left and right heel, metres from the middle of the hips, axes of the frame's camera.
  /// `trans` is the middle of the hips.
  std::vector<MatrixX3d> landmarks;
  Eigen::VectorXd betas;  ///< of the system's body; the mean of its frames'
};

struct BodyEstimate {
  std::string system;                                     ///< "WHAM"
  std::string body;                                       ///< whose betas: "smpl", "smplx" or the name of a track's
  Eigen::Vector3d rest_pelvis = Eigen::Vector3d::Zero();  ///< of that body, metres: `trans` plus this is the pelvis
  int num_frames = 0;  ///< of the video, where entry i is frame i; 0: entries have frame numbers of their own
  std::vector<PersonEstimate> people;  ///< at least one, each of at least one frame; largest and longest in view first
  bool has_landmarks = false;          ///< points in place of poses; rest_pelvis is 0, the hips' middle the pelvis
};

/// What the image says of a body: where its pelvis is seen, its size there, and the line of sight it is turned against.
struct PelvisInImage {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double px_per_metre = 0;                        ///< of what is parallel to the image
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();  ///< (x/z, y/z) in the estimate's own camera; weak perspective: 0, 0
};

/// Of entry i of a person; nothing when the pelvis is not in front of the camera.
std::optional<PelvisInImage> PelvisOf(const PersonEstimate& person, size_t i, const Eigen::Vector3d& rest_pelvis);

/// The person in `camera` (pinhole): with the pelvis seen at pixel p under ray r and s pixels a metre there, and a ray
/// r' and a focal length f' of `camera`, the pelvis is put to (f'/s)·(r', 1), and the root turned by the smallest
/// rotation from r to r'. In the estimate's own camera nothing changes. `num_frames` rows, NaN where the person is
/// missing; timestamps are left empty. `estimate_pelvis` is the pelvis of the estimate's body at rest, `pelvis` that of
/// the body whose `trans` is wanted. Throws std::invalid_argument for a frame beyond num_frames and a camera that is no
/// pinhole.
Motion EstimateInCamera(const PersonEstimate& person, const Camera& camera, int num_frames,
                        const Eigen::Vector3d& estimate_pelvis, const Eigen::Vector3d& pelvis);

/// The same of landmarks: T of 21×3 in `camera`'s frame, without rows where the person is missing.
std::vector<MatrixX3d> LandmarksInCamera(const PersonEstimate& person, const Camera& camera, int num_frames);

/// Which of the people is the one with these landmarks: the highest Σ over frames of max(0, 1 − d/reach), with d the
/// distance from the pelvis to the middle of the hips (reach 0.35 m at the person's own size) or, where a hip is not
/// seen, to the middle of the landmarks that are (0.8 m). −1 when nobody is ever within reach.
int PersonSeenAs(const BodyEstimate& estimate, const KeypointSequence& keypoints);

}  // namespace bodyloom
