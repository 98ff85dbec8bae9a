// SPDX-License-Identifier: Apache-2.0
/// Evaluates a track fitted to one camera against the detections in the other cameras of a rig.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// One camera of a rig and its detections of COCO's 17 landmarks.
struct RigView {
  std::string name;
  Camera camera;
  CameraPose pose;              ///< camera from world, metres
  KeypointSequence detections;  ///< CocoNames() in order
};

/// A clip recorded by several calibrated cameras, with the joints determined from all of them.
struct MultiViewClip {
  std::string name;
  std::vector<RigView> views;
  std::vector<MatrixX3d> coco17_in_world;                 ///< T of 17×3 metres; NaN where unknown
  Eigen::Vector3d up_in_world = Eigen::Vector3d::Zero();  ///< the vertical; zero: not known
  Motion motion;            ///< T SMPL poses in the world frame; num_frames() = 0 when there are none
  double motion_scale = 1;  ///< metres of the world per metre of the motion's body (its shape is the template's)
  double fps = 0;           ///< nominal; used to difference positions instead of rounded timestamps
};

struct EvaluateHeldOutViewsOptions {
  double min_confidence = 0.3;  ///< detections above this are used
};

/// Protocol "held-out views". The track (camera frame of the view it was fitted to, coco17 in metres) and the clip are
/// matched by frame index over the frames both have. With P the track's landmarks, G the clip's in the camera frame of
/// the fitted view, and hip(·) the mid-hip of COCO's hips:
///   clip_scale         s = argmin Σ ‖s (P − hip P) − (G − hip G)‖²
///   mpjpe_mm, mpjpe_scaled_mm   mean ‖(P − hip P) − (G − hip G)‖, and with s
///   pa_mpjpe_mm, pa_p95_mm, pa_over_120_percent   after one similarity a frame (geometry/math/procrustes.h)
///   accel_err_ms2, gt_accel_ms2 ‖P″ − G″‖ and ‖G″‖
///   root_err_mm        mean ‖hip P − hip G‖, and its parts across and along the viewing direction
///   heldout_*          distance in pixels of s (P − hip P) + hip G, carried into every other camera, to its detections
///   fitview_*          distance of P, through the clip's camera, to the fitted view's detections
///   fitview_own_*      the same through the track's own camera (differs when the focal length was estimated)
/// and PCK, percent of person height (data_tools/evaluation/metrics_image.h); where the vertical is known and the track
/// states a world, the errors in the room (data_tools/evaluation/room_errors.h); with `motion`, the angle between the
/// track's joint rotations and SMPL's, both on the same 24 joints, the root's in the camera frame; and the errors of
/// angles between landmarks (data_tools/evaluation/joint_angle_errors.h). A frame whose
/// landmarks are not all finite is scored with the nearest frame that has them. Throws std::invalid_argument when the
/// view is unknown, sizes disagree, or nothing overlaps.
Evaluation EvaluateHeldOutViews(const Track& track, const MultiViewClip& clip, const std::string& view,
                                const EvaluateHeldOutViewsOptions& options = {});

}  // namespace bodyloom
