// SPDX-License-Identifier: Apache-2.0
/// The plan of truncated roll-outs: which frames a recurrent network trains on, step by step.
///
/// A batch holds `places` places. Each belongs to `rollouts` truncated roll-outs that take turns: step s belongs to
/// roll-out s mod `rollouts` of every place. A roll-out goes through the clip frame by frame, so that the network's
/// prediction of one frame is at hand as the input of the next (detached: nothing is propagated back through time).
/// After `length` frames, or where a stretch of frames ends, it restarts at a random frame: with the truth of the frame
/// before as its past (share `from_truth`), or with nothing, as a clip begins. This follows the only published recipe
/// for such a renderer (Kappel et al., "High-Fidelity Neural Human Motion Transfer from Monocular Video", CVPR 2021:
/// own detached predictions, replaced by truth every 500 frames), with shorter roll-outs because clips here are
/// shorter. Taking turns is this project's: neighbouring frames are nearly alike, and an optimizer whose every step
/// shows it the next frame of one roll-out averages over few pictures (docs/motion_renderer.md). First roll-outs are
/// shorter the later they come, so that not all restart at once.
///
/// A function of the seed alone, so that a run can go on from any step.
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom {

/// Frames [begin, end) of a clip, without a gap.
struct FrameRange {
  int begin = 0, end = 0;
};

struct RolloutStep {
  int frame = 0;
  int rollout = 0;          ///< of the place's roll-outs, below Options::rollouts
  bool restart = false;     ///< the past is not the prediction of the step before
  bool from_truth = false;  ///< of a restart: the truth of frame − 1; otherwise nothing
};

class RolloutPlan {
 public:
  struct Options {
    int places = 4;
    int rollouts = 1;
    int length = 32;
    double from_truth = 0.75;
    uint64_t seed = 1;
  };
  /// Ranges of at least one frame; throws std::invalid_argument when there is none.
  RolloutPlan(std::vector<FrameRange> ranges, const Options& options);

  /// The frames of the next step, one a place.
  std::vector<RolloutStep> Next();
  /// As if Next had been called `steps` times.
  void Skip(int64_t steps);

 private:
  struct Rollout {
    int frame = 0, end = 0, left = 0;
  };
  std::vector<FrameRange> ranges_;
  std::vector<int64_t> frames_up_to_;
  Options options_;
  std::vector<Rollout> rollouts_;  ///< by roll-out, then by place
  int64_t step_ = 0;
};

}  // namespace bodyloom
