// SPDX-License-Identifier: Apache-2.0
/// Early stopping of a training by its loss on held-out frames.
///
/// People whose clothes move differently in every motion are best after a minute or two; longer training overfits the
/// motions of the clip. Every `every` steps the training loss is evaluated on held-out frames; v_k is the mean of the
/// last `smoothed` values. When the minimum of v_k is at least `min_patience` and patience_share · (steps at the
/// minimum) steps ago, the cooldown starts: the progress p, which controls all rates (avatar_trainer.h), rises linearly
/// from its current value to 1 within max(min_cooldown, cooldown_share · steps done) steps, and training ends. Without
/// such a plateau there is no cooldown. The result is the person with the minimum held-out loss, including the last one
/// (AvatarTrainingState::kept).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

struct EarlyStoppingOptions {
  int every = 250;                                  ///< steps between evaluations; 0: none
  int smoothed = 3;                                 ///< evaluations that are averaged
  int64_t min_patience = 1000, min_cooldown = 500;  ///< steps
  double patience_share = 0.5, cooldown_share = 0.5;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct EarlyStopping {
  std::vector<double> losses;    ///< after every, 2 · every, … steps
  int64_t cooldown_step = 0;     ///< start of the cooldown; 0: not started
  double cooldown_progress = 0;  ///< progress of the training at that step

  /// Adds the loss after `step` steps at this progress, and starts the cooldown according to the rule above.
  void Add(double loss, int64_t step, double progress, const EarlyStoppingOptions& options);
  /// 0 before the cooldown, then the progress rising to 1.
  [[nodiscard]] double Progress(int64_t step, const EarlyStoppingOptions& options) const;
  /// Steps at the minimum of v_k; 0 before the first evaluation.
  [[nodiscard]] int64_t BestStep(const EarlyStoppingOptions& options) const;
};

}  // namespace bodyloom
