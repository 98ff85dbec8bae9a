// SPDX-License-Identifier: Apache-2.0
/// The demo: synthesises a clip, tracks it, evaluates the track and shows the result on one page.
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

/// Runs the steps that the page lists as command lines: synth, track, evaluate. Reports each step. Throws
/// std::runtime_error naming a file that cannot be used, Cancelled.
DemoReport RunDemo(const DemoRequest& request, const PipelineCallbacks& callbacks = {});

/// Closing text: outcome, accuracy, and the files to look at.
std::string ToText(const DemoReport& report);

}  // namespace bodyloom
