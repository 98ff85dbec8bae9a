// SPDX-License-Identifier: Apache-2.0
/// Evaluates a track against reference data: named errors with units.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "pipelines/score/rig_clip.h"

namespace bodyloom {

struct EvaluateTrackRequest {
  std::string track;  ///< .npz
  /// Reference data, which determines the protocol: a track or part labels (.npz), an AIST++ folder (keypoints2d/), or
  /// a Pose2Sim folder (calib_refined.json). Without this and `seen`: the track alone (evaluation.h).
  std::string truth;
  /// Instead of `truth`: detections of the person by two or more calibrated cameras of a rig; `cameras` is the
  /// calibration, `view` the camera that the track was fitted to (rig_clip.h).
  std::vector<RigDetections> seen;
  std::string body;      ///< body of track and truth; empty: the built-in one
  std::string cameras;   ///< AIST++: camera folder; empty: truth/cameras
  std::string sequence;  ///< AIST++: name of the clip
  std::string view;      ///< camera that the track was fitted to; empty: c01 (AIST++), cam_01 (Pose2Sim)
  std::string json;      ///< EvaluationJson; empty: not written
};

/// Evaluates the track and writes the requested files. Throws RequestError when an AIST++ clip is not named or both
/// `truth` and `seen` are given, std::runtime_error naming a file that cannot be used, Cancelled before the evaluation
/// starts.
Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks = {});

/// The same for a track in memory, its body, and optionally a true track of this body; the corresponding files of the
/// request are not read.
Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const BodyModel& body, const Track& track,
                         const Track* truth, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
