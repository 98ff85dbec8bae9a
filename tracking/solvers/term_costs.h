// SPDX-License-Identifier: Apache-2.0
/// The cost of a clip's problem by term, over the whole clip and in its second of worst fit.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// ½ Σ ρ of one term's residuals.
struct TermCosts {
  std::string term;  ///< FrameTerm::name(), "smoothness", "velocity", "shape prior", "stature", "focal length prior"
  Eigen::VectorXd of_frame;  ///< T: costs between frames count at the last of them; empty: not by frame
  double cost = 0;           ///< total
};

/// Costs of all terms at the problem's states, in the order in which they are summed; their sum is the problem's cost.
/// Same bytes for any number of threads. `residuals`, if given, receives the pixel residuals of the terms that have
/// some.
std::vector<TermCosts> CostsByTerm(const SequenceProblem& problem, int num_threads,
                                   FrameResiduals* residuals = nullptr);

/// Finds the second of the clip with the highest cost per frame, and the term whose cost per frame there exceeds its
/// mean over the clip by the largest amount. None for clips of less than two seconds.
std::optional<WorstStretch> FindWorstStretch(const std::vector<TermCosts>& costs,
                                             const std::vector<double>& timestamps);

/// Fills the summary's table of costs and its worst stretch, and `residuals` as CostsByTerm() does.
void SummariseCosts(const SequenceProblem& problem, int num_threads, FrameResiduals* residuals,
                    TrackSequenceSummary* summary);

}  // namespace bodyloom
