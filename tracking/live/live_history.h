// SPDX-License-Identifier: Apache-2.0
/// What a live tracker remembers of the 2D joints: the last seconds, cleaned, and a thinned sample of the whole shot.
/// Memory is bounded.
#pragma once

#include <string>
#include <vector>

#include "geometry/observations.h"

namespace bodyloom {

class LiveHistory {
 public:
  /// Keeps `seconds` of frames, at most `max_frames` of them, and as many of the thinned sample.
  LiveHistory(std::vector<std::string> names, int image_width, int image_height, double seconds, int max_frames);

  /// Appends a frame: unusable joints become missing, left–right pairs that jump to each other's place are exchanged
  /// back (RepairSwaps() over the last frames). Returns true when it does not continue the frames before (FindCuts());
  /// then these are forgotten.
  bool Add(double timestamp, const std::vector<Keypoint>& points);

  /// Frames …, newest − 2·stride, newest − stride, newest: at most `count`, oldest first.
  [[nodiscard]] KeypointSequence Recent(int count, int stride) const;
  /// At most max_frames of the shot, evenly thinned.
  [[nodiscard]] const KeypointSequence& Sample() const { return sample_; }
  /// Whether the newest frame shows a landmark that the solver would use.
  [[nodiscard]] bool NewestIsSeen() const;
  /// Median time step of the last frames, seconds; 0 with fewer than two.
  [[nodiscard]] double TimeStep() const;
  [[nodiscard]] int num_frames() const { return all_.num_frames(); }
  /// Makes the next frame the first of a shot.
  void Forget();
  [[nodiscard]] int num_swaps_repaired() const { return num_swaps_repaired_ / 2; }

 private:
  KeypointSequence all_, sample_;
  double seconds_;
  int max_frames_, sample_step_ = 1, since_sample_ = 0, num_swaps_repaired_ = 0;
  KeypointSequence last_seen_;  ///< the newest frame that shows a person, alone
};

}  // namespace bodyloom
