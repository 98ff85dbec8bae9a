// SPDX-License-Identifier: Apache-2.0
/// Tracks a person while the frames come in: one frame in, the pose of the frame `lag` frames before out.
///
/// The last frames are solved together by a fixed-lag smoother (tracking/chain/fixed_lag.h); what older frames said
/// about pose, shape and focal length stays as a prior. Time and memory of a frame are bounded, whatever comes: every
/// frame gets a status and none is waited for. How it works, and what it costs: docs/live.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {

struct LiveTrackerOptions {
  int lag = 4;               ///< frames: Push() of frame t returns frame t − lag. 0 to 60
  int context = 4;           ///< frames before those that stay in the window; at least 2
  int iterations = 2;        ///< of each frame
  int start_iterations = 8;  ///< of each of the first lag + 1 frames of a shot
  int max_dense = 600;       ///< dense keypoints of a frame; of more, about this many stand for all
  double lost_after_s = 1;   ///< without any observation the person is lost
  /// Frames whose 2D joints jump away from the person count as not seen until they come back, or until they have lasted
  /// for longer than this; then there is a cut, at the first of them that has not been handed out. 0: a cut at once
  double max_jump_s = 0.15;
  double skip_settled = 0.1;  ///< SolveOptions::skip_settled
  /// Camera knowledge, weights, threads, estimate_shape, skip_unneeded and estimate_uncertainty mean what they mean for
  /// TrackSequence().
  TrackSequenceOptions solve;
  /// False with the reason when a field is out of range.
  bool IsValid(std::string* why) const;
};

/// What stays the same from frame to frame. Pointers are borrowed; those that may be null are marked.
struct LiveTrackerInput {
  const BodyModel* body = nullptr;
  const PosePrior* prior = nullptr;       ///< or null
  const LifterWeights* lifter = nullptr;  ///< or null: starts by joint hypotheses
  Camera camera;                          ///< known: all of it; otherwise only width and height
  std::vector<std::string> landmarks;     ///< names of the 2D joints of each frame; may be empty when dense
  bool dense = false;                     ///< dense keypoints may come
};

/// One frame as it comes. Anything may be missing or not finite; it counts as not seen.
struct LiveObservations {
  double timestamp = 0;             ///< seconds, larger than the frame's before
  std::vector<Keypoint> keypoints;  ///< one a landmark, or none
  std::vector<DenseKeypoint> dense;
  std::optional<BodyPose> initialiser;  ///< of another system, camera frame: start and L_d of paper A
};

struct LiveFrame {
  int64_t index = 0;  ///< of the Push() that brought it
  double timestamp = 0;
  FrameStatus status = FrameStatus::kLost;
  bool cut_before = false;  ///< does not continue the frame before
  FrameState state;         ///< NaN when lost
  Eigen::VectorXd betas;    ///< as known when the frame is handed out
  Camera camera;            ///< of the frame, with the focal length as known then
  /// J standard deviations of the joints' positions, metres (uncertainty.h), as known then; NaN when lost, or without
  /// TrackSequenceOptions::estimate_uncertainty.
  Eigen::VectorXd joint_sigma;
};

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
