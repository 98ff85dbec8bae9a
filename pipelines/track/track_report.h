// SPDX-License-Identifier: Apache-2.0
/// The report of a tracked clip: as text for a reader, and as JSON for a program.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/stopwatch.h"
#include "pipelines/track/clip_camera_path.h"
#include "tracking/clip/initialiser_gain.h"
#include "tracking/clip/track_plan.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// Poses of another system that the fit began with.
struct InitialiserReport {
  std::string system, person;    ///< as the file calls them
  int people = 0, frames = 0;    ///< in the file; of the clip that have a pose
  bool has_shape = false;        ///< its shape is one of the body that is fitted
  bool gives_landmarks = false;  ///< points of another body, no rotations
  InitialiserGain gain;
};

struct TrackReport {
  TrackSequenceSummary solve;
  int num_frames = 0;
  WorldFrame world;  ///< the track's
  CameraPathReport camera_path;
  std::optional<InitialiserReport> initialiser;
  StageSeconds seconds;  ///< TrackClip's own stages; the one named kSolveStage is split by solve.seconds
  double total_seconds = 0;
  size_t peak_memory_bytes = 0;
  std::string detections;
  std::vector<std::string> outputs;  ///< files written
};

constexpr const char* kSolveStage = "solve";

/// The job's stages with the solve replaced by the solver's own stages and what they leave unexplained.
StageSeconds StagesOf(const TrackReport& report);

/// Frames by status, error, time by stage, what was skipped and why: about fifteen lines, the last one with a newline.
std::string ToText(const TrackReport& report);

/// The same as one JSON object; the keys are listed in docs/command.md. Numbers that are not finite become null.
std::string ToJson(const TrackReport& report);

/// A plan as lines "run   what: why" / "skip  what: why".
std::string ToText(const std::vector<PlanEntry>& plan);

/// What follows a focal length: ", estimated within 20.0 % (standard deviation)"; empty when it was known or its spread
/// is not.
std::string FocalSigmaText(double focal_log_sigma);

}  // namespace bodyloom
