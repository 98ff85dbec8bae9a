// SPDX-License-Identifier: Apache-2.0
/// The two-camera protocol on Pose2Sim's balancing trial: fit one camera, score in the other.
///
/// There is no 3D truth: joints triangulated from both cameras' detections stand in for it (triangulated_clip.h).
#pragma once

#include <string>

#include "bodyloom/data_tools/evaluation/evaluation.h"
#include "bodyloom/data_tools/evaluation/held_out_views.h"
#include "bodyloom/data_tools/evaluation/triangulated_clip.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

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
