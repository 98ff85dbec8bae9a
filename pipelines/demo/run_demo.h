// SPDX-License-Identifier: Apache-2.0
/// The demo: a clip is made, tracked, evaluated and shown on one page.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/evaluation/evaluation.h"
#include "geometry/base/callbacks.h"
#include "pipelines/track/track_report.h"

namespace bodyloom {

struct DemoRequest {
  std::string out = "demo";  ///< folder
  int num_frames = 0;        ///< only the first; 0: all 6 seconds
  uint64_t seed = 1;         ///< of the faults
  int num_threads = 0;       ///< 0: all cores
};

struct DemoReport {
  TrackReport track;
  Evaluation evaluation;                       ///< against the known truth
  std::string page, overlay_path, track_path;  ///< files written: summary.html, overlay.mp4, track.npz
};

/// Takes the very steps that its page lists as command lines: synth, track, evaluate. Says what each step does. Throws
/// std::runtime_error naming a file that cannot be used, Cancelled.
DemoReport RunDemo(const DemoRequest& request, const PipelineCallbacks& callbacks = {});

/// The closing words: how it went, how well, and what to look at.
std::string ToText(const DemoReport& report);

}  // namespace bodyloom
