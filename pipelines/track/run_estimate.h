// SPDX-License-Identifier: Apache-2.0
/// Estimate of the time and memory of TrackPeopleClip() before it runs.
///
/// The first second of the clip is detected as the run would do it. That gives the number of people, and the processor
/// time of a frame of detection on this machine; its ratio to the reference machine's scales the other stages, whose
/// rates were measured there (docs/lab/run_speed.md, "How cost grows"):
///   detect    measured here
///   track     fits × Σ people (a + b m h²) per frame, m = 1 with masks, h the person's height in pixels / 1000
///   overlay   (c + d pixels + e people) per frame
/// Wall-clock time is processor time / threads^0.75, as stages keep two cores 80 % busy.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "pipelines/track/track_people_clip.h"

namespace bodyloom {

/// The quantities that decide about the cost.
struct RunWork {
  int num_frames = 1;
  double fps = 30;
  int width = 0, height = 0;
  std::vector<double> people_px;  ///< heights in the image of those who would be tracked
  bool masks = true, overlay = true;
  double detect_s = 0.03;     ///< processor seconds a frame of detection takes here
  double detect_start_s = 0;  ///< … and to load the networks
  double machine = 1;         ///< processor seconds here for one of the reference machine
  int threads = 2;
};

struct RunEstimate {
  StageSeconds processor_seconds;  ///< detect, track, overlay
  double seconds = 0;              ///< wall-clock
  size_t peak_memory_bytes = 0;
};

RunEstimate EstimateRun(const RunWork& work);

/// The clip's frames, the people of its first second, and the estimate.
struct RunPlan {
  RunWork work;
  RunEstimate estimate;
};

/// Throws as TrackPeopleClip() does for a contradictory request or a video that cannot be read; nobody in the first
/// second counts as one person of half the image's height.
RunPlan PlanRun(const TrackPeopleClipRequest& request, const PipelineCallbacks& callbacks = {});

/// "about 14 s (detect 6.3, track 3.2, overlay 4.0), 0.45 GB, for 367 frames of 576x1024 with 1 person", and the rest.
std::string ToText(const RunPlan& plan);
/// The same as one JSON object; the keys are listed in docs/command.md.
std::string ToJson(const RunPlan& plan);

}  // namespace bodyloom
