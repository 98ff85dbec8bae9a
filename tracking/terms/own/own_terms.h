// SPDX-License-Identifier: Apache-2.0
/// Users' own terms (own_term.h) in a clip's problem.
#pragma once

#include <span>
#include <vector>

#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/terms/own/own_term.h"
#include "bodyloom/tracking/track_summary.h"

namespace bodyloom {

/// Asks every term for its cost functions and puts them into the problem's frames; its frames, cuts and layout must be
/// set. Throws std::invalid_argument, in one line that names term and frame, for CheckOwnTerm()'s reasons and when the
/// parameter blocks of a cost function do not have the sizes of what the term reads.
void AddOwnTerms(std::span<const OwnTerm> terms, SequenceProblem* problem);

/// One entry a term.
std::vector<PlanEntry> PlanOwnTerms(std::span<const OwnTerm> terms);
/// How each term fits at the problem's state.
std::vector<OwnTermSummary> SummariseOwnTerms(std::span<const OwnTerm> terms, const SequenceProblem& problem);

}  // namespace bodyloom
