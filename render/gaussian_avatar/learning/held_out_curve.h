// SPDX-License-Identifier: Apache-2.0
/// How well a training does on frames that it does not learn from, and when it should end because of that.
///
/// A person of a pattern that falls elsewhere in every motion is learned best in a minute or two; more steps learn the
/// motions of the clip by heart, and others get worse. So now and then the held-out frames are judged, by the loss that
/// is learned by; v_k is the mean of the last `smoothed` such losses. When the least v_k is `least_wait` and
/// wait_share · (steps done at it) steps ago, the training *lands*: its progress p, which all rates follow
/// (avatar_trainer.h), goes on a straight line from what it is to 1 within max(least_landing, landing_share · steps
/// done) steps, and it ends there. A training that goes on getting better never lands. What it leaves is the person of
/// the least loss that was judged, the last one included (AvatarTrainingState::kept).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

struct HeldOutOptions {
  int every = 250;                                 ///< steps between judgements; 0: there are none
  int smoothed = 3;                                ///< judgements that are averaged
  int64_t least_wait = 1000, least_landing = 500;  ///< steps
  double wait_share = 0.5, landing_share = 0.5;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct HeldOutCurve {
  std::vector<double> losses;   ///< after every, 2 · every, … steps
  int64_t landing_step = 0;     ///< since when it lands; 0: it does not
  double landing_progress = 0;  ///< of the training, then

  /// Adds the loss after `step` steps of a training of this progress, and begins to land where the rule above says so.
  void Add(double loss, int64_t step, double progress, const HeldOutOptions& options);
  /// 0 before landing, then rising to 1.
  [[nodiscard]] double Progress(int64_t step, const HeldOutOptions& options) const;
  /// Steps done when v_k was least; 0 before the first judgement.
  [[nodiscard]] int64_t BestStep(const HeldOutOptions& options) const;
};

}  // namespace bodyloom
