// SPDX-License-Identifier: Apache-2.0
/// Solves a SequenceProblem with the engine that the options name.
#pragma once

#include <utility>
#include <vector>

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Solves the problem and writes the solution to its states, betas and log_focal. The solution has the same bytes for
/// any number of threads. Chain, too, solves more than options.max_frames_at_once frames in overlapping windows, with
/// shape and focal length held; its report's costs are then sums over the windows. Throws std::invalid_argument when
/// the problem's sizes contradict each other.
SolveReport SolveSequence(SequenceProblem* problem, const SolveOptions& options);

/// Windows begin ≤ t < end of `size` frames that cover a clip and overlap by kWindowOverlap.
inline constexpr int kWindowOverlap = 100;
std::vector<std::pair<int, int>> WindowsOf(int num_frames, int size);

/// Flags of about `count` of a clip's frames, in stretches of 50 that lie evenly over it.
std::vector<char> StretchesOf(int num_frames, int count);

/// Stretches of a clip as a problem of their own, to find the values that all frames share with the memory of a few.
/// The shared priors have the frames' share of their weight, so the optimum is that of the whole clip where the
/// stretches show what it shows, and a variance is the whole clip's divided by `share`.
struct SequenceSample {
  std::vector<int> frames;  ///< of the clip
  double share = 1;         ///< of the clip's frames
  SequenceProblem part;     ///< with a cut before each stretch

  SequenceSample(const SequenceProblem& problem, int count);
};

/// The frames begin ≤ t < end as a problem of their own. The frames next to them that accelerations couple are in it,
/// too, and are to be held (SolveOptions::held), so that there is no seam and a solve of the window lowers the cost of
/// the whole.
struct SequenceWindow {
  std::vector<int> frames;  ///< of the clip
  std::vector<char> held;
  SequenceProblem part;

  SequenceWindow(const SequenceProblem& problem, int begin, int end);
  /// Puts the states of the frames that are not held into the clip's problem.
  void PutInto(SequenceProblem* problem);
};

/// Implements SolveSequence() with Ceres: Levenberg–Marquardt with sparse Cholesky on the blocks of ceres_problem.h,
/// for any structure.
SolveReport SolveWithCeres(SequenceProblem* problem, const SolveOptions& options);

/// Makes OpenMP regions that this thread enters run on this thread only, during its lifetime. CHOLMOD's supernodal
/// factorisation requests four threads for every supernode, on any machine: a chain of frames has thousands of small
/// ones, so the threads sleep and wake 8,000 times a factorisation and the solve takes twice as long, with the same
/// bytes as its result. (SuiteSparse 5.12, CHOLMOD_OMP_NUM_THREADS.)
class SerialOpenMp {
 public:
  SerialOpenMp();
  ~SerialOpenMp();
  SerialOpenMp(const SerialOpenMp&) = delete;
  SerialOpenMp& operator=(const SerialOpenMp&) = delete;

 private:
  int levels_;
};

}  // namespace bodyloom
