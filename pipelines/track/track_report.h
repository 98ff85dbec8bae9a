// SPDX-License-Identifier: Apache-2.0
/// Report of a tracked clip: as text for a reader, and as JSON for a program.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/evaluation/room_physics.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/track/clip_camera_path.h"
#include "pipelines/track/view_report.h"
#include "tracking/clip/initialiser_gain.h"
#include "tracking/clip/track_plan.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// Initial poses of another system used by the fit.
struct InitialiserReport {
  std::string system, person;    ///< as the file calls them
  int people = 0, frames = 0;    ///< people in the file; frames of the clip with a pose
  bool has_shape = false;        ///< it has the shape of the fitted body
  bool gives_landmarks = false;  ///< it has landmarks of another body, no rotations
  InitialiserGain gain;
};

struct TrackReport {
  TrackSequenceSummary solve;
  int num_frames = 0;
  WorldFrame world;  ///< the track's
  RoomPhysics room;  ///< of the track, where a ground was found or given; else of no frame
  CameraPathReport camera_path;
  std::optional<InitialiserReport> initialiser;
  std::vector<ViewReport> views;  ///< of a track from several cameras, the first's first
  StageSeconds seconds;           ///< TrackClip's own stages; the one named kSolveStage is split by solve.seconds
  double total_seconds = 0;
  size_t peak_memory_bytes = 0;
  std::string detections;
  std::vector<std::string> outputs;  ///< files written
};

constexpr const char* kSolveStage = "solve";

/// The job's stages, with the solve replaced by the solver's own stages and the remaining time.
StageSeconds StagesOf(const TrackReport& report);

/// Frames by status, error, time by stage, skipped steps with reasons: about fifteen lines ending in a newline.
std::string ToText(const TrackReport& report);

/// The same as one JSON object; the keys are listed in docs/command.md. Numbers that are not finite become null.
/// `initialiser` has system, person, people, frames, has_shape, gives_landmarks; over compared_frames the median and
/// 95th percentile (_median_, _p95_) of joint_…_mm (pelvis aligned), root_…_mm, rotation_…_deg, root_…_deg; over
/// `landmarks` 2D joints those of initialiser_…_px and fit_…_px.
std::string ToJson(const TrackReport& report);

/// The plan as lines "run   what: why" / "skip  what: why".
std::string ToText(const std::vector<PlanEntry>& plan);

/// Text that follows a focal length: ", estimated within 20.0 % (standard deviation)"; empty if the focal length was
/// given or its standard deviation is unknown.
std::string FocalSigmaText(double focal_log_sigma);

/// A line for each hand and the head that were fitted after the body, or why they were not: "left hand seen in 253 of
/// 367 frames, 31 px long; median 2.10 px". Nothing without hands and faces.
std::string FittedPartsText(const TrackSequenceSummary& summary);

}  // namespace bodyloom
