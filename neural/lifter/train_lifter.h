// SPDX-License-Identifier: Apache-2.0
/// Trains the lifter (geometry/scene/lifter_weights.h): AdamW with a cosine schedule on windows generated on demand by
/// a source, exponential moving average of the weights, validation on windows of other seeds.
///
/// A run folder holds `metrics.csv` (a line every `report_every` steps), `checkpoint.bin` (replaced atomically) and the
/// caller's final output. An interrupted run resumes from its checkpoint and ends with the same bytes as an
/// uninterrupted one (same machine, same number of threads).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry/scene/lifter_weights.h"
#include "neural/training/training_run.h"

namespace bodyloom {

/// One window of T frames: the network's input and target (tracking/lifter/lifter_input.h,
/// geometry/scene/lifter_weights.h).
struct LifterExample {
  std::vector<float> features;  ///< T·num_inputs
  std::vector<float> points;    ///< T·21·3
  std::vector<float> up;        ///< T·3
  std::vector<float> contact;   ///< T·2
};
/// Fills the example of a seed; called from several threads.
using LifterSource = std::function<void(uint64_t seed, LifterExample* example)>;

struct TrainLifterOptions : TrainingRun {
  const LifterWeights* begin_with = nullptr;  ///< initial weights of the same sizes; null: random from the seed
  TrainLifterOptions() {
    steps = 10000;
    report_every = 100, validate_every = 1000, checkpoint_every = 500;
  }
  int num_inputs = 0;   ///< features per frame
  int num_frames = 81;  ///< of a window
  int width = 256;      ///< channels
  std::vector<int> dilations = {1, 2, 4, 8, 16, 1};
  int batch = 32;
  double learning_rate = 1.5e-3;
  int warmup_steps = 100;
  double weight_decay = 1e-3;
  bool muon = true;  ///< for the matrices of the blocks (neural/training/optimizers.h); false: AdamW for all weights
  double clip_norm = 1;
  double average = 0.998;  ///< decay of the moving average of the weights
  double nll_weight = 0.05, velocity_weight = 0.3;
  int validation_windows = 256;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TrainLifterSummary : TrainingOutcome {
  double validation_distance = 0;       ///< mean |d| of the most likely hypotheses, in torso + leg lengths
  double validation_best_distance = 0;  ///< error of each limb's best hypothesis
};

struct TrainLifterResult {
  LifterWeights weights;  ///< the moving average
  TrainLifterSummary summary;
};

/// `train` and `validation` are called with distinct seeds within a run. Throws std::invalid_argument for options that
/// are not valid and std::runtime_error when a file cannot be read or written, or a checkpoint is of another network. A
/// loss that is not finite ends the run (kNotFinite); the last checkpoint is kept.
TrainLifterResult TrainLifter(const LifterSource& train, const LifterSource& validation,
                              const TrainLifterOptions& options);

}  // namespace bodyloom
