// SPDX-License-Identifier: Apache-2.0
/// History of a live tracker's 2D joints: the last seconds, cleaned, and a thinned sample of the whole shot. Memory is
/// bounded.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/observations.h"

namespace bodyloom {

/// Relation of a frame to the ones before.
enum class Continuity {
  kContinues,
  kHeld,  ///< it jumps away, perhaps for a short time; until that is known it counts as not seen
  kCut    ///< neither it nor the held frames continue them
};

class LiveHistory {
 public:
  /// Keeps `seconds` of frames, at most `max_frames` of them, and as many of the thinned sample.
  LiveHistory(std::vector<std::string> names, int image_width, int image_height, double seconds, int max_frames);

  /// Appends a frame: unusable joints become missing, and swapped left–right pairs are exchanged back (RepairSwaps()
  /// over the last frames).
  ///
  /// Frames from a jump on (FindCuts()) are held. They stay empty when a later frame continues the frame before the
  /// jump (ContinuesFrame()). A held frame more than hold_s after the first of them makes a cut: all earlier frames are
  /// dropped, and the history begins with the held frames since the last jump among them. With hold_s = 0, or more than
  /// a second after the person was last seen, a jump is a cut at once.
  Continuity Add(double timestamp, const std::vector<Keypoint>& points, double hold_s);

  /// Frames …, newest − 2·stride, newest − stride, newest: at most `count`, oldest first.
  [[nodiscard]] KeypointSequence Recent(int count, int stride) const;
  /// At most max_frames of the shot, evenly thinned.
  [[nodiscard]] const KeypointSequence& Sample() const { return sample_; }
  /// True if the newest frame shows a landmark that the solver would use.
  [[nodiscard]] bool NewestIsSeen() const;
  /// Median time step of the last frames, seconds; 0 with fewer than two.
  [[nodiscard]] double TimeStep() const;
  [[nodiscard]] int num_frames() const { return all_.num_frames(); }
  /// Makes the next frame the first of a shot.
  void Forget();
  [[nodiscard]] int num_swaps_repaired() const { return num_swaps_repaired_ / 2; }

 private:
  /// True if `frame` does not continue `before`: FindCuts().
  [[nodiscard]] static bool IsCut(const KeypointSequence& before, const KeypointSequence& frame);
  /// Appends a clean frame that continues the ones before.
  void Put(KeypointSequence frame);
  [[nodiscard]] KeypointSequence Empty() const;
  void DropOld();

  KeypointSequence all_, sample_;
  double seconds_;
  int max_frames_, sample_step_ = 1, since_sample_ = 0, num_swaps_repaired_ = 0;
  KeypointSequence last_seen_;  ///< the newest frame that shows a person, alone
  KeypointSequence held_;       ///< all frames since the jump
  KeypointSequence held_seen_;  ///< the newest of them that shows a person, alone
  int held_begin_ = 0;          ///< the first of them that the newest may continue
};

}  // namespace bodyloom
