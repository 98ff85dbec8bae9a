// SPDX-License-Identifier: Apache-2.0
/// Evaluates tracks on clips of calibrated cameras without a 3D truth: joints triangulated from the cameras' detections
/// take its place.
///
/// They determine the mid-hip and the global scale of the clip, which are not observable with a single camera. So pose
/// and orientation are scored, as on AIST++.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/held_out_views.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct TriangulatedClipOptions {
  double min_confidence = 0.3;       ///< of detections, for triangulation and scoring
  double max_triangulation_px = 20;  ///< joints with a larger residual (root mean square) are unknown
};

/// Converts detections to COCO's landmarks in its order. Throws std::runtime_error beginning with `where` when one is
/// missing.
KeypointSequence AsCoco17(const KeypointSequence& detections, const std::string& where);

/// Triangulates the joints of the frames that all views have: T of 17×3 metres in the world; NaN for joints seen in
/// fewer than two views or inconsistently.
std::vector<MatrixX3d> TriangulateViews(const std::vector<RigView>& views, const TriangulatedClipOptions& options = {});

/// Protocol "rig-held-out": EvaluateHeldOutViews on a clip whose joints came from TriangulateViews(), and their
/// distance from the detections (triangulation_median_px, triangulation_p95_px, triangulated_percent): a lower bound of
/// their noise, because two cameras observe only its component across the epipolar lines. `view` is the camera the
/// track was fitted to.
Evaluation EvaluateTriangulatedClip(const Track& track, const MultiViewClip& clip, const std::string& view,
                                    const TriangulatedClipOptions& options = {});

// Triangulation of a point from its pixels in several calibrated cameras.

/// Observation of a point by one camera. Borrowed pointers.
struct Sighting {
  const Camera* camera = nullptr;    ///< pinhole
  const CameraPose* pose = nullptr;  ///< camera from world
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

struct TriangulatedPoint {
  bool is_valid = false;  ///< two or more rays that meet at more than 1°, the point in front of every camera
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();  ///< metres
  double rms_px = 0;                                         ///< distance of its projections to the pixels
};

/// argmin_X Σ_i ‖π_i(X) − pixel_i‖²: the point nearest to all rays (least squares), refined by Gauss–Newton on pixels.
/// Source: Hartley and Zisserman, "Multiple View Geometry", chapter 12.
TriangulatedPoint TriangulatePoint(std::span<const Sighting> sightings);

// The two-camera protocol on Pose2Sim's balancing trial: a fit to one camera is scored in the other.
//
// There is no 3D truth: joints triangulated from both cameras' detections take its place.

struct Pose2SimOptions {
  std::string trial = "balancing";
  double fps = 60;
  TriangulatedClipOptions triangulation;
};

/// Reads `folder`/calib_refined.json and `folder`/<trial>/json_single/cam0{1,2}_json: OpenPose BODY_25B in the
/// calibration's pixels, one person. (The videos' pixels and frame numbers differ: video frame = JSON frame + 1, and
/// video_to_calib_affine.json.) Throws std::runtime_error naming the file that cannot be used.
MultiViewClip ReadPose2SimClip(const std::string& folder, const Pose2SimOptions& options = {});

/// Protocol "pose2sim-held-out": EvaluateTriangulatedClip() on that clip. `view` is the camera the track was fitted to.
Evaluation EvaluatePose2Sim(const Track& track, const MultiViewClip& clip, const std::string& view = "cam_01",
                            const Pose2SimOptions& options = {});
Evaluation EvaluatePose2Sim(const Track& track, const std::string& folder, const std::string& view = "cam_01",
                            const Pose2SimOptions& options = {});

}  // namespace bodyloom
