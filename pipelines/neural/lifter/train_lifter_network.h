// SPDX-License-Identifier: Apache-2.0
/// Trains the network that lifts 2D joints to 3D from recorded motion; implements `bodyloom train lifter`.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/lifter/train_lifter.h"

namespace bodyloom {

struct TrainLifterNetworkRequest {
  std::vector<std::string> motions;  ///< motion files, or folders of them (data_tools/motion/motion_library.h)
  std::string split;                 ///< list of training clips; empty: the project's own
  double share = 1;                  ///< share of the training motion that is used, in whole clips
  std::string init_from;             ///< initial weights, of the same sizes; empty: random
  std::string out;  ///< folder of the run: config.json, motion_split.txt, metrics.csv, checkpoint.bin, lifter.npz
  /// Hyperparameters; fields that depend on the windows (num_inputs, num_frames, run_dir) are set by the job.
  TrainLifterOptions options;
};

struct TrainLifterNetworkSummary : TrainLifterSummary {
  std::string weights;        ///< the weights file; others are written beside it
  size_t num_parameters = 0;  ///< of the weights file
};

/// Trains the network. A stopped run ends with its checkpoint and weights and status TrainingStatus::kStopped.
/// Throws RequestError for invalid options and when a run already exists, std::runtime_error for files that cannot be
/// used, including weights of other sizes, and when a loss is not finite.
TrainLifterNetworkSummary TrainLifterNetwork(const TrainLifterNetworkRequest& request,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
