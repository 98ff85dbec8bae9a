// SPDX-License-Identifier: Apache-2.0
/// Tracks a person while the frames come in: one frame in, the pose of the frame `lag` frames before out.
///
/// The last frames are solved together by a fixed-lag smoother (tracking/solvers/fixed_lag.h); what older frames
/// implied about pose, shape and focal length stays as a prior. Time and memory of a frame are bounded, whatever comes:
/// every frame gets a status and none is waited for. How it works, and what it costs: docs/live.md.
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
  /// Throws std::invalid_argument when input or options cannot be.
  LiveTracker(const LiveTrackerInput& input, const LiveTrackerOptions& options);
  ~LiveTracker();
  LiveTracker(LiveTracker&&) noexcept;
  LiveTracker& operator=(LiveTracker&&) noexcept;

  /// The frame `lag` before this one; nothing for the first `lag` frames. Throws std::invalid_argument, and changes
  /// nothing, when the timestamp is not finite or does not increase, when there is another number of 2D joints than
  /// landmarks, or when a dense keypoint names a face that the body does not have.
  std::optional<LiveFrame> Push(const LiveObservations& observations);
  /// The frames that are left, when no more will come. The next Push() begins a new clip.
  std::vector<LiveFrame> Finish();

  [[nodiscard]] const FrameLayout& layout() const;
  [[nodiscard]] const Eigen::VectorXd& betas() const;
  [[nodiscard]] double log_focal() const;
  [[nodiscard]] int64_t num_iterations() const;
  [[nodiscard]] int num_swaps_repaired() const;
  /// Frames that jumped away from the person and back.
  [[nodiscard]] int64_t num_frames_left_out() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
