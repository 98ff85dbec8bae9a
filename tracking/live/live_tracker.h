// SPDX-License-Identifier: Apache-2.0
/// Tracks a person in a stream of frames: each new frame returns the pose of the frame `lag` frames earlier.
///
/// The last frames are solved jointly by a fixed-lag smoother (tracking/solvers/fixed_lag.h); the information of older
/// frames on pose, shape and focal length is kept as a prior. Time and memory per frame are bounded for any input, and
/// every frame gets a status without further delay. How it works, and what it costs: docs/live.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tracking/live/live_options.h"
#include "tracking/problem/frame_layout.h"

namespace bodyloom {

class LiveTracker {
 public:
  /// Throws std::invalid_argument for invalid input or options.
  LiveTracker(const LiveTrackerInput& input, const LiveTrackerOptions& options);
  ~LiveTracker();
  LiveTracker(LiveTracker&&) noexcept;
  LiveTracker& operator=(LiveTracker&&) noexcept;

  /// Adds a frame and returns the one `lag` frames before it; nothing for the first `lag` frames. Throws
  /// std::invalid_argument, and changes nothing, when the timestamp is not finite or does not increase, when there is
  /// another number of 2D joints than landmarks, or when a dense keypoint is on a face that the body does not have.
  std::optional<LiveFrame> Push(const LiveObservations& observations);
  /// Ends the clip and returns its remaining frames. The next Push() begins a new clip.
  std::vector<LiveFrame> Finish();

  [[nodiscard]] const FrameLayout& layout() const;
  [[nodiscard]] const Eigen::VectorXd& betas() const;
  [[nodiscard]] double log_focal() const;
  [[nodiscard]] int64_t num_iterations() const;
  [[nodiscard]] int num_swaps_repaired() const;
  /// Number of frames that jumped away from the person and back.
  [[nodiscard]] int64_t num_frames_left_out() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
