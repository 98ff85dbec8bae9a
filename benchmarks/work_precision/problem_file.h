// SPDX-License-Identifier: Apache-2.0
/// A WorkProblem as numbers, for fitters written in Python (benchmarks/peers/pytorch_fit.py), and what they answer.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/work_precision/work_problem.h"

namespace bodyloom {

/// Every array that the cost needs (names and shapes: class Problem of the script). Throws std::runtime_error.
void WriteProblemFile(const WorkProblem& work, const std::string& path);

/// Where a fitter stood at one moment.
struct PeerMoment {
  double seconds = 0, cpu_seconds = 0;  ///< wall, and processor time of the process
  int iterations = 0;
  SequenceProblem answer;
};
std::vector<PeerMoment> ReadPeerFile(const WorkProblem& work, const std::string& path);

}  // namespace bodyloom
