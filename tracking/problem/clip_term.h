// SPDX-License-Identifier: Apache-2.0
/// A term over a clip: it puts its part into the frames' lists (frame_term.h), learns from answers, and finds anew what
/// corresponds to what where it needs rounds. TrackSequence() makes those of term_kinds.h and calls them in the
/// order in which they are declared here.
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

/// What terms of a clip are made from; all of it outlives them.
struct ClipTermInput {
  const TrackSequenceInput& input;  ///< with the observations that can be meant
  const TrackSequenceOptions& options;
  const FrameLayout& layout;
  const ObservedLandmarks& landmarks;
  const KeypointSequence* joints = nullptr;  ///< 2D joints that the lifter has read; null: none
  const LiftedStart& lifted;                 ///< without frames where the lifter does not run
  const LiftedLandmarks& lifted_landmarks;
  double stature_m = 0;
  int num_threads = 1;
};

class ClipTerm {
 public:
  virtual ~ClipTerm() = default;
  ClipTerm() = default;
  ClipTerm(const ClipTerm&) = delete;
  ClipTerm& operator=(const ClipTerm&) = delete;

  /// Puts its part into all frames of the clip's problem, which start at its states, in the camera frame of each. Terms
  /// are summed in the order in which they come here, so a part that comes later is put in empty.
  virtual void Observe(SequenceProblem* /*problem*/) {}
  /// All terms are in, and the states are where they are solved: in the scene of a camera that moves.
  virtual void BeginFit(SequenceProblem* /*problem*/) {}
  /// A first answer is there: `coarse` holds `frames` of the clip. True when the term has changed in both problems, and
  /// what was solved with it is to be solved again.
  virtual bool LearnFrom(const std::vector<int>& /*frames*/, SequenceProblem* /*coarse*/,
                         SequenceProblem* /*problem*/) {
    return false;
  }
  /// Solves on the coarse frames, each after a StartRound(); and one StartRound() before all frames are solved.
  struct Rounds {
    int count = 0;
    int max_iterations = 0;  ///< of a solve
    const char* stage = "";  ///< its name in summary and progress
  };
  [[nodiscard]] virtual Rounds rounds() const { return {}; }
  /// `problem` holds `frames` of the clip; `round` counts from 0, and is the last one for all frames.
  virtual void StartRound(int /*round*/, const std::vector<int>& /*frames*/, SequenceProblem* /*problem*/) {}
  /// With the answer in `problem`.
  virtual void Summarise(const SequenceProblem& /*problem*/, TrackSequenceSummary* /*summary*/) const {}
};

/// A term whose part of a frame is put in once: `observe(t, state, frame)` for every frame.
std::unique_ptr<ClipTerm> EachFrame(std::function<void(int, const FrameState&, FrameData*)> observe);

}  // namespace bodyloom
