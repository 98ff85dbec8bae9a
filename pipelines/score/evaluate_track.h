// SPDX-License-Identifier: Apache-2.0
/// A track against what is known: errors by name, with units.
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
  /// What is known, and thereby the protocol: a track or part labels (.npz), an AIST++ folder (keypoints2d/), or a
  /// Pose2Sim folder (calib_refined.json). Neither this nor `seen`: the track alone (evaluation.h).
  std::string truth;
  /// Instead of `truth`: what the calibrated cameras of a rig saw of the person, two or more; `cameras` is the
  /// calibration, `view` the camera that the track was fitted to (rig_clip.h).
  std::vector<RigDetections> seen;
  std::string body;      ///< that both were made with; empty: the built-in one
  std::string cameras;   ///< AIST++: camera folder; empty: truth/cameras
  std::string sequence;  ///< AIST++: name of the clip
  std::string view;      ///< camera that the track was fitted to; empty: c01 (AIST++), cam_01 (Pose2Sim)
  std::string json;      ///< EvaluationJson; empty: not written
};

/// Measures the track and writes the numbers where requested. Throws RequestError when an AIST++ clip is not named, or
/// both `truth` and `seen` are given, std::runtime_error naming a file that cannot be used, Cancelled before the
/// measuring begins.
Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks = {});

/// The same for a track in memory, its body, and, when it is given, a true track of that body; the request's files of
/// them are not read.
Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const BodyModel& body, const Track& track,
                         const Track* truth, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
