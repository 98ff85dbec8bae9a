// SPDX-License-Identifier: Apache-2.0
/// Renders a clip frame by frame from its motion alone. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>
#include <cstdint>
#include <vector>

#include "geometry/base/prefetcher.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_model.h"
#include "neural/motion/person_box.h"
#include "neural/motion/rollout_plan.h"
#include "neural/training/checkpoint.h"

namespace bodyloom {

// Batches of a training run, prefetched by a separate thread.

struct MotionBatch {
  std::vector<RolloutStep> steps;
  std::vector<MotionFrame> frames;  ///< without images and maps, only the positions of their windows
  std::vector<PixelBox> boxes;      ///< part of each window that the networks see
  MotionInput input;                ///< of the boxes
  MotionTruth truth;                ///< of the boxes
  std::vector<MotionState> past;  ///< whole windows, 1×…, for roll-outs that restart from truth; else without parts
};

/// Batches of steps first … last − 1 of a plan. `reach`: of clothes, pixels (for config.around_body).
class MotionBatches {
 public:
  MotionBatches(const MotionFrameSource& source, const MotionConfig& config, int reach, RolloutPlan plan, int64_t first,
                int64_t last);

  /// Waits for the next batch and returns it. Throws what the source threw.
  MotionBatch Take() { return ahead_.Take(); }
  [[nodiscard]] double waited_s() const { return ahead_.waited_s(); }

 private:
  RolloutPlan plan_;
  Prefetcher<MotionBatch> ahead_;
};

/// Reach of clothes beyond the body, pixels along x or y; 0: not known.
struct Reach {
  int pixels = 0;
  /// True: the person may be anywhere in the networks' box. False: pixels beyond reach are set to background, as the
  /// recurrence would preserve spurious ones.
  bool whole_window = false;
};

/// Keeps the recurrent state. The descriptor of unchanged motion maps and its projection by unchanged surface
/// coordinates are reused; the results are identical.
class RollOut {
 public:
  /// The first frame is rendered `warmup_iterations` times in advance, each time with its own last result as its past.
  /// Throws std::invalid_argument when the networks see only the body's box (config.around_body) and the reach is not
  /// known.
  RollOut(MotionModel model, int warmup_iterations, Reach reach = {});

  /// Renders the next frame's whole window: state and foreground (other fields are for training and undefined). No
  /// gradients.
  MotionStepResult Next(const MotionFrame& frame);
  /// Starts another clip with the next frame.
  void Restart();

  [[nodiscard]] int64_t descriptors_kept() const { return descriptors_kept_; }
  [[nodiscard]] int64_t projections_kept() const { return projections_kept_; }

 private:
  void KeepWithinReach(const torch::Tensor& body, MotionStepResult* result) const;

  MotionModel model_;
  int warmup_;
  Reach reach_;
  MotionState past_;  ///< whole window
  MotionInput last_;
  torch::Tensor descriptor_, projected_;
  int64_t descriptors_kept_ = 0, projections_kept_ = 0;
};

// Stores the last prediction of every truncated roll-out of a training run (neural/motion/rollout_plan.h) as the past
// of its next frame.

class RolloutMemory {
 public:
  /// `nothing`: the past of a clip's first frame, 1×…; batches have `places` places with `rollouts` roll-outs each.
  RolloutMemory(MotionState nothing, int places, int rollouts);

  /// Adds the state as "past_labels", "past_image" and "past_normals".
  void AddTo(Checkpoint* checkpoint);
  /// Moves the state to the device; call it after a checkpoint was loaded. Throws std::invalid_argument when the number
  /// of roll-outs differs.
  void Begin();

  /// The past of every place of a batch, B×…, shifted to the current window and cropped to its box: the roll-out's
  /// prediction of the previous frame or, for a restart, batch.past or `nothing`.
  [[nodiscard]] MotionState Before(const MotionBatch& batch) const;
  /// Stores the prediction of a batch's boxes, detached; background outside of them.
  void Keep(const MotionBatch& batch, const MotionState& predicted);

 private:
  [[nodiscard]] int64_t PlaceOf(const RolloutStep& step) const { return int64_t{step.rollout} * places_; }

  MotionState nothing_, last_;  ///< last_: (rollouts·B)×…, grouped by turn, whole windows
  int64_t places_, rollouts_;
};

}  // namespace bodyloom
