// SPDX-License-Identifier: Apache-2.0
/// Base of a term over a clip: it adds its frame terms to the frames' lists (frame_term.h), adapts to solutions, and
/// updates correspondences between rounds. TrackSequence() makes those of term_kinds.h and calls the functions below in
/// the order of their declaration.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

struct LiftedLandmarks;
struct LiftedStart;
struct ObservedLandmarks;
struct TrackSequenceInput;
struct TrackSequenceOptions;
struct TrackSequenceSummary;
struct ViewObservations;

/// Input for making the terms of a clip; all of it outlives them.
struct ClipTermInput {
  const TrackSequenceInput& input;  ///< with cleaned observations
  const TrackSequenceOptions& options;
  const FrameLayout& layout;
  const ObservedLandmarks& landmarks;
  const KeypointSequence* joints = nullptr;  ///< 2D joints that the lifter used; null: none
  const LiftedStart& lifted;                 ///< without frames where the lifter does not run
  const LiftedLandmarks& lifted_landmarks;
  const std::vector<ViewObservations>& views;  ///< the other views
  double stature_m = 0;
  int num_threads = 1;
};

class ClipTerm {
 public:
  virtual ~ClipTerm() = default;
  ClipTerm() = default;
  ClipTerm(const ClipTerm&) = delete;
  ClipTerm& operator=(const ClipTerm&) = delete;

  /// Adds its terms to all frames of the clip's problem, whose starting states are in the camera frame of each. Terms
  /// are summed in the order in which they are added, so a term that gets its observations later is added empty.
  virtual void Observe(SequenceProblem* /*problem*/) {}
  /// T flags, true for frames with observations of the term, if only some frames have them; empty: all have. The coarse
  /// frames are chosen so that they have them (FramesAtRate()).
  [[nodiscard]] virtual std::vector<char> SparseFrames() const { return {}; }
  /// Called after all terms have been added and the states are in the frame of the solve: for a moving camera, the
  /// scene.
  virtual void BeginFit(SequenceProblem* /*problem*/) {}
  /// Called with a first solution: `coarse` holds `frames` of the clip. Returns true when the term has changed in both
  /// problems, which must then be solved again.
  virtual bool LearnFrom(const std::vector<int>& /*frames*/, SequenceProblem* /*coarse*/,
                         SequenceProblem* /*problem*/) {
    return false;
  }
  /// Rounds of the term: solves on the coarse frames, each after a StartRound(), and one StartRound() before all frames
  /// are solved.
  struct Rounds {
    int count = 0;
    int max_iterations = 0;  ///< of a solve
    const char* stage = "";  ///< its name in summary and progress; terms that name the same one share its solves
  };
  [[nodiscard]] virtual Rounds rounds() const { return {}; }
  /// Called with all coarse frames before the rounds. `in_windows`: the rounds are run in one window of the clip after
  /// the other, and so is the solve of all frames, so that only a window's correspondences need be kept.
  virtual void BeginRounds(const std::vector<int>& /*coarse_frames*/, bool /*in_windows*/) {}
  /// Updates the term for a round. `problem` holds `frames` of the clip; `round` counts from 0, and is the last one for
  /// all frames.
  virtual void StartRound(int /*round*/, const std::vector<int>& /*frames*/, SequenceProblem* /*problem*/) {}
  /// Adds the term's part of the summary, with the solution in `problem`.
  virtual void Summarise(const SequenceProblem& /*problem*/, TrackSequenceSummary* /*summary*/) const {}
};

/// A term that is added once to each frame, by `observe(t, state, frame)`.
std::unique_ptr<ClipTerm> EachFrame(std::function<void(int, const FrameState&, FrameData*)> observe);

}  // namespace bodyloom
