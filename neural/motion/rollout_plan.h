// SPDX-License-Identifier: Apache-2.0
/// Plans truncated roll-outs: the frames on which a recurrent network is trained in each step.
///
/// A batch has `places` places, each with `rollouts` truncated roll-outs in turn: step s belongs to roll-out s mod
/// `rollouts` of every place. A roll-out traverses the clip frame by frame, with the network's prediction of one frame
/// as input of the next (detached: no backpropagation through time). After `length` frames, or at the end of a range of
/// frames, it restarts at a random frame: with the truth of the previous frame as its past (share `from_truth`), or
/// without a past, as at the start of a clip. This follows the only published recipe for such a renderer (Kappel et
/// al., "High-Fidelity Neural Human Motion Transfer from Monocular Video", CVPR 2021: own detached predictions,
/// replaced by truth every 500 frames), with shorter roll-outs because clips here are shorter. Several roll-outs per
/// place are this project's addition: neighbouring frames are nearly identical, and consecutive steps on a single
/// roll-out would average over few images (docs/lab/motion_renderer.md). The first roll-outs have staggered lengths, so
/// that restarts do not coincide.
///
/// Depends on the seed alone, so that a run can resume from any step.
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
  int rollout = 0;          ///< number among the place's roll-outs, below Options::rollouts
  bool restart = false;     ///< the past is not the prediction of the step before
  bool from_truth = false;  ///< past of a restart: the truth of frame − 1; otherwise none
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
  /// `ranges` must contain at least one frame; throws std::invalid_argument otherwise.
  RolloutPlan(std::vector<FrameRange> ranges, const Options& options);

  /// The frames of the next step, one per place.
  std::vector<RolloutStep> Next();
  /// Equivalent to `steps` calls of Next.
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
