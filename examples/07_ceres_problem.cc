// SPDX-License-Identifier: Apache-2.0
// Builds the ceres::Problem of a track: prints the cost of each term and the residual blocks of highest cost, solves it
// by Ceres with the lifter's weight doubled, and prints the uncertainty of a knee.
#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/synthesis/clips/demo_motion.h"
#include "bodyloom/data_tools/synthesis/clips/synth_clip.h"
#include "bodyloom/tracking/build_ceres_problem.h"

using namespace bodyloom;
int main() {
  const SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 24, 15), {});
  TrackSequenceInput input;
  input.keypoints = &clip.keypoints, input.camera = clip.truth.camera;
  const auto clip_problem = BuildCeresProblem(input);
  CeresProblem& blocks = *clip_problem->blocks();
  ceres::Problem& problem = blocks.problem();
  const std::vector<double> costs = blocks.CostByTerm();
  for (size_t i = 0; i < costs.size(); ++i) std::printf("%-20s %8.3f\n", blocks.terms()[i].c_str(), costs[i]);

  std::vector<std::pair<double, const CeresProblem::Block*>> pulls;
  for (const CeresProblem::Block& block : blocks.residual_blocks()) {
    double cost = 0;
    problem.EvaluateResidualBlock(block.id, true, &cost, nullptr, nullptr);
    pulls.push_back({cost, &block});
  }
  std::sort(pulls.rbegin(), pulls.rend());
  for (int i = 0; i < 3; ++i) {
    std::vector<double*> parameters;
    problem.GetParameterBlocksForResidualBlock(pulls[i].second->id, &parameters);
    std::printf("%.3f: %s, up to the %s\n", pulls[i].first, blocks.terms()[pulls[i].second->term].c_str(),
                blocks.NameOf(parameters.back()).c_str());
  }

  blocks.SetWeight("lifter", 2);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::printf("%s\n", summary.BriefReport().c_str());
  ceres::Covariance covariance{ceres::Covariance::Options()};
  double* knee = blocks.rotation(12, BuiltinBody().FindJoint("l_knee"));
  double in_tangent[9];
  if (covariance.Compute(std::vector<std::pair<const double*, const double*>>{{knee, knee}}, &problem) &&
      covariance.GetCovarianceBlockInTangentSpace(knee, knee, in_tangent)) {
    std::printf("flexion of the knee in frame 12 is known to %.1f degrees\n", std::sqrt(in_tangent[0]) * 180 / M_PI);
  }
  std::printf("%s\n", clip_problem->Finish().summary.BriefReport().c_str());
}
