// SPDX-License-Identifier: Apache-2.0
/// Trains the network that lifts 2D joints to 3D from recorded motion: what `bodyloom train lifter` does.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/lifter/train_lifter.h"

namespace bodyloom {

struct TrainLifterNetworkRequest {
  std::vector<std::string> motions;  ///< motion files, or folders of them (data_tools/motion/motion_library.h)
  std::string split;                 ///< which clips are for training; empty: the project's own list
  double share = 1;                  ///< of the training motion that is used, whole clips
  std::string init_from;             ///< weights to begin with, of the same sizes; empty: random ones
  std::string out;  ///< folder of the run: config.json, motion_split.txt, metrics.csv, checkpoint.bin, lifter.npz
  /// Numbers; what follows from the windows (num_inputs, num_frames, run_dir) is filled in by the job.
  TrainLifterOptions options;
};

struct TrainLifterNetworkSummary : TrainLifterSummary {
  std::string weights;        ///< the file written, and others beside it
  size_t num_parameters = 0;  ///< numbers in it
};

/// A run that was stopped ends with its checkpoint and weights and says so (TrainingStatus::kStopped). Throws
/// RequestError for options that are not valid and for a run that is there, std::runtime_error for files that cannot be
/// used, weights of other sizes among them, and when a loss is not finite.
TrainLifterNetworkSummary TrainLifterNetwork(const TrainLifterNetworkRequest& request,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
