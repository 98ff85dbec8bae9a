// SPDX-License-Identifier: Apache-2.0
/// The cost of a clip's problem by term: which term weighs how much, over the whole clip and where it fits worst.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// ½ Σ ρ of one term's residuals.
struct TermCosts {
  std::string term;  ///< FrameTerm::name(), "smoothness", "velocity", "shape prior", "stature", "focal length prior"
  Eigen::VectorXd of_frame;  ///< T: of what lies between frames at the last of them; empty: of no frame
  double cost = 0;           ///< in all
};

/// At the problem's states; their costs sum to the problem's. Terms come in the order in which they are summed. The
/// same bytes for any number of threads.
std::vector<TermCosts> CostsByTerm(const SequenceProblem& problem, int num_threads);

/// The second of the clip whose cost a frame is highest, and the term whose cost a frame there is most above what it is
/// in the whole clip. Nothing for clips of less than two seconds.
std::optional<WorstStretch> FindWorstStretch(const std::vector<TermCosts>& costs,
                                             const std::vector<double>& timestamps);

/// Fills the summary's table of costs and its worst stretch.
void SummariseCosts(const SequenceProblem& problem, int num_threads, TrackSequenceSummary* summary);

}  // namespace bodyloom
