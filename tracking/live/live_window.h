// SPDX-License-Identifier: Apache-2.0
/// The last frames of a live tracker: what came of them, what is remembered of their 2D joints, and the window that the
/// solver has over them.
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

/// A frame that has not been handed out yet or is in the window.
struct LiveRecord {
  int64_t index = 0;  ///< of the Push() that brought it
  double timestamp = 0;
  int shot = 0;
  bool cut_before = false, seen = false, in_window = false, handed_out = false;
  FrameStatus status = FrameStatus::kLost;
  std::vector<DenseKeypoint> dense;
  std::optional<BodyPose> initialiser;
  LiftedPose lifted;
  /// What came with 2D joints that jumped away (Continuity::kHeld), until it is known whether they come back. `seen`,
  /// `dense` and `initialiser` are those of an empty frame so long.
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

  /// Takes a frame's observations (history included) as the newest record; ends the shot where it does not continue the
  /// frames before, or where nothing has been seen for too long.
  LiveRecord& Append(const LiveObservations& observations);
  /// Puts the record, the first one that is not there yet, into the solver's window.
  void Add(LiveRecord* record, const FrameState& start, bool cut);
  /// A record of the window, of which something else is known now, becomes the next frame of the shot.
  void Replace(LiveRecord* record, const FrameState& start, bool cut);
  /// What the solver sees of a record.
  [[nodiscard]] FrameData Observe(const FrameState& state, LiveRecord* record) const;
  /// False when the window had to be given up; the shot has ended then.
  bool Solve(int iterations);
  void EndShot();
  /// JointSigmaOf() in frames begin ≤ slot < end of the solver's window; NaN where they cannot be determined.
  PositionSigma Uncertainty(int begin, int end);
  /// Forgets records that nobody needs any more.
  void DropDone();

  /// All records, oldest first.
  std::deque<LiveRecord>& records() { return records_; }
  [[nodiscard]] const std::deque<LiveRecord>& records() const { return records_; }
  /// Records of the current shot that have not been handed out: the last so many.
  [[nodiscard]] int NumOpen() const;
  /// The record of a frame of the solver's window that belongs to the current shot.
  LiveRecord& RecordAt(int slot) { return records_[records_.size() - static_cast<size_t>(lag_->num_frames() - slot)]; }
  /// The frame of the solver's window that is this record's.
  [[nodiscard]] int SlotOf(const LiveRecord& record) const;
  /// Frames at the window's end that belong to the current shot.
  [[nodiscard]] int NumOfShotInWindow() const;

  FixedLag& lag() { return *lag_; }
  [[nodiscard]] const SequenceProblem& problem() const { return lag_->problem(); }
  [[nodiscard]] const LiveHistory& history() const { return history_; }
  /// The camera as a pinhole with the focal length as known now.
  [[nodiscard]] Camera PinholeNow() const;

  bool tracking = false;  ///< a shot is under way
  [[nodiscard]] int shot_frames() const { return shot_frames_; }
  [[nodiscard]] int64_t frames_of_clip() const { return frames_of_clip_; }
  [[nodiscard]] int64_t first_index() const { return first_index_; }
  [[nodiscard]] int64_t iterations() const { return iterations_; }
  [[nodiscard]] int64_t num_frames_left_out() const { return num_held_; }

 private:
  /// The last `count` records were held and belong to a shot of their own, as far as they are still open.
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
