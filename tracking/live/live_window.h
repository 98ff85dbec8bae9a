// SPDX-License-Identifier: Apache-2.0
/// The last frames of a live tracker: their observations, the history of their 2D joints, and the solver's window over
/// them.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "tracking/clip/uncertainty.h"
#include "tracking/live/live_history.h"
#include "tracking/live/live_setup.h"
#include "tracking/solvers/fixed_lag.h"

namespace bodyloom {

/// A frame that has not been returned yet or is in the window.
struct LiveRecord {
  int64_t index = 0;  ///< of the Push() that brought it
  double timestamp = 0;
  int shot = 0;
  bool cut_before = false, seen = false, in_window = false, handed_out = false;
  FrameStatus status = FrameStatus::kLost;
  std::vector<DenseKeypoint> dense;
  std::optional<BodyPose> initialiser;
  LiftedPose lifted;
  std::optional<LiveFrame::Standing> standing;
  /// Observations of a held frame (Continuity::kHeld), kept until the jump is known to be a cut or not. Until then
  /// `seen`, `dense` and `initialiser` of the record are those of an empty frame.
  struct Held {
    std::vector<DenseKeypoint> dense;
    std::optional<BodyPose> initialiser;
    bool seen = false;
  };
  std::optional<Held> held;
};

/// Frames of the window point into it: not to be copied.
class LiveWindow {
 public:
  LiveWindow(const LiveSetup& setup, int64_t first_index);
  LiveWindow(const LiveWindow&) = delete;
  LiveWindow& operator=(const LiveWindow&) = delete;

  /// Appends a frame's observations to the records and to the history; ends the shot when the frame does not continue
  /// the ones before, or when nothing has been seen for too long.
  LiveRecord& Append(const LiveObservations& observations);
  /// Adds the record, which must be the first outside the solver's window, to the window.
  void Add(LiveRecord* record, const FrameState& start, bool cut);
  /// Observes a record of the window anew, with the state `start`, as the next frame of the shot.
  void Replace(LiveRecord* record, const FrameState& start, bool cut);
  /// Terms of a record for the solver.
  [[nodiscard]] FrameData Observe(const FrameState& state, LiveRecord* record) const;
  /// Returns false when the solve failed and the window was discarded; the shot has then ended.
  bool Solve(int iterations);
  void EndShot();
  /// Standard deviations (JointSigmaOf()) for frames begin ≤ slot < end of the solver's window; NaN where they cannot
  /// be determined.
  PositionSigma Uncertainty(int begin, int end);
  /// Drops records that are no longer needed.
  void DropDone();

  /// All records, oldest first.
  std::deque<LiveRecord>& records() { return records_; }
  [[nodiscard]] const std::deque<LiveRecord>& records() const { return records_; }
  /// Number of records of the current shot that have not been returned; they are the last ones.
  [[nodiscard]] int NumOpen() const;
  /// The record of a frame of the solver's window that belongs to the current shot.
  LiveRecord& RecordAt(int slot) { return records_[records_.size() - static_cast<size_t>(lag_->num_frames() - slot)]; }
  /// Index of this record's frame in the solver's window.
  [[nodiscard]] int SlotOf(const LiveRecord& record) const;
  /// Number of frames at the window's end that belong to the current shot.
  [[nodiscard]] int NumOfShotInWindow() const;

  FixedLag& lag() { return *lag_; }
  [[nodiscard]] const SequenceProblem& problem() const { return lag_->problem(); }
  [[nodiscard]] const LiveHistory& history() const { return history_; }
  /// The camera as a pinhole with the focal length as known now.
  [[nodiscard]] Camera PinholeNow() const;

  bool tracking = false;  ///< true during a shot
  [[nodiscard]] int shot_frames() const { return shot_frames_; }
  [[nodiscard]] int64_t frames_of_clip() const { return frames_of_clip_; }
  [[nodiscard]] int64_t first_index() const { return first_index_; }
  [[nodiscard]] int64_t iterations() const { return iterations_; }
  [[nodiscard]] int64_t num_frames_left_out() const { return num_held_; }

 private:
  /// Assigns the last `count` records, which were held, to the current shot, except those already returned.
  void Release(int count);

  const LiveSetup& setup_;
  std::unique_ptr<FixedLag> lag_;
  LiveHistory history_;
  std::deque<LiveRecord> records_;
  int64_t first_index_, next_index_;  ///< of the clip; of the next record
  int64_t frames_of_clip_ = 0, iterations_ = 0, num_held_ = 0;
  int shot_ = 0, shot_frames_ = 0;  ///< which one; its tracked frames so far
  double last_seen_s_ = 0;
};

}  // namespace bodyloom
