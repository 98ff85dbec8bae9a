// SPDX-License-Identifier: Apache-2.0
/// Problems on which solvers are compared: a real motion seen by a known camera as dense keypoints of known noise, with
/// an initial error of known size. Cost: keypoints (Geman–McClure), accelerations, pose prior, shape prior.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data_tools/synthesis/clips/synth_clip.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/terms/pose_prior/pose_prior.h"

namespace bodyloom {

struct WorkProblemOptions {
  std::string motion;           ///< file; empty: DemoMotion at 30 frames a second
  std::string noise = "pixel";  ///< DenseFaults()
  int frames = 100;             ///< the motion is played forwards and backwards repeatedly
  int first_frame = 0;
  int dense = 300;  ///< keypoints per frame
  double start_error_px = 14.8;
  uint64_t seed = 1;
};

/// Not copyable, as it holds pointers into itself.
struct WorkProblem {
  SynthClip clip;
  std::shared_ptr<const MixturePrior> prior;
  SequenceProblem problem;  ///< at its initial values
  WorkProblem() = default;
  WorkProblem(const WorkProblem&) = delete;
  WorkProblem& operator=(const WorkProblem&) = delete;
};

std::unique_ptr<WorkProblem> MakeWorkProblem(const WorkProblemOptions& options);

/// Mean projected distance between every tenth vertex of the fitted and of the true body, pixels of the image scaled to
/// 512 by its longer side.
double ProjectionErrorPx(const WorkProblem& work, const std::vector<FrameState>& states, const Eigen::VectorXd& betas);

// Exchange of a WorkProblem and its solutions with fitters written in Python (benchmarks/peers/pytorch_fit.py).

/// Writes every array that the cost needs (names and shapes: class Problem of the script). Throws std::runtime_error.
void WriteProblemFile(const WorkProblem& work, const std::string& path);

/// State of a fitter at one time.
struct PeerMoment {
  double seconds = 0, cpu_seconds = 0;  ///< wall, and processor time of the process
  int iterations = 0;
  SequenceProblem answer;
};
std::vector<PeerMoment> ReadPeerFile(const WorkProblem& work, const std::string& path);

}  // namespace bodyloom
