// SPDX-License-Identifier: Apache-2.0
/// The two-camera protocol on Pose2Sim's balancing trial: fit one camera, score in the other.
///
/// There is no 3D truth. The joints that stand in for it are triangulated from both cameras' detections
/// (data_tools/evaluation/triangulation.h): they place the mid-hip and give the clip's one scale, because a single
/// camera knows neither. What is scored is therefore pose and orientation, as on AIST++.
#pragma once

#include <string>

#include "bodyloom/data_tools/evaluation/evaluation.h"
#include "bodyloom/data_tools/evaluation/held_out_views.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

struct Pose2SimOptions {
  std::string trial = "balancing";
  double fps = 60;
  double min_confidence = 0.3;       ///< of detections, for triangulation and scoring
  double max_triangulation_px = 20;  ///< joints whose two sightings disagree by more (root mean square) are unknown
};

/// Reads `folder`/calib_refined.json and `folder`/<trial>/json_single/cam0{1,2}_json: OpenPose BODY_25B in the
/// calibration's pixels, one person. (The videos' pixels and frame numbers differ: video frame = JSON frame + 1, and
/// video_to_calib_affine.json.) Throws std::runtime_error naming the file that cannot be used.
MultiViewClip ReadPose2SimClip(const std::string& folder, const Pose2SimOptions& options = {});

/// Protocol "pose2sim-held-out": EvaluateHeldOutViews on that clip, and how far the triangulated joints themselves lie
/// from the detections (triangulation_median_px, triangulation_p95_px, triangulated_percent): a lower bound of their
/// noise, because two cameras see only its part across the epipolar lines.
/// `view` is the camera the track was fitted to.
Evaluation EvaluatePose2Sim(const Track& track, const MultiViewClip& clip, const std::string& view = "cam_01",
                            const Pose2SimOptions& options = {});
Evaluation EvaluatePose2Sim(const Track& track, const std::string& folder, const std::string& view = "cam_01",
                            const Pose2SimOptions& options = {});

}  // namespace bodyloom
