// SPDX-License-Identifier: Apache-2.0
/// The peers solve the same problem: equal cost at the start, and the same minimum.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "benchmarks/work_precision/autodiff_peer.h"
#include "benchmarks/work_precision/measure.h"
#include "benchmarks/work_precision/work_problem.h"
#include "data_tools/formats/npz.h"
#include "geometry/base/check.h"
#include "tests/support/paths.h"
#include "tracking/terms/upright.h"

namespace bodyloom::peer_test {
namespace {

std::unique_ptr<WorkProblem> Problem(int frames, const std::string& noise) {
  WorkProblemOptions options;
  options.frames = frames;
  options.dense = 300;
  options.noise = noise;
  return MakeWorkProblem(options);
}

SolveReport Solve(SequenceProblem* problem, Engine engine) {
  engine.options.function_tolerance = 1e-10;
  engine.options.max_iterations = 300;
  return engine.solve(problem, engine.options);
}

double InitialCost(const SequenceProblem& problem) {
  SequenceProblem copy = problem;
  Engine engine = CeresEngine(1);
  engine.options.max_iterations = 1;
  return engine.solve(&copy, engine.options).initial_cost;
}

/// The minima may differ (the pose prior is the nearest of several components), but each must be one.
TEST(Peers, AutoDiffMinimisesTheSameCost) {
  for (const char* noise : {"pixel", "densepose"}) {
    for (int frames : {1, 3}) {
      const auto work = Problem(frames, noise);
      SequenceProblem problem = work->problem;
      const SolveReport report = Solve(&problem, AutoDiffEngine(2));
      EXPECT_NEAR(report.initial_cost / InitialCost(work->problem), 1, 1e-12) << noise << " " << frames;
      EXPECT_NEAR(report.final_cost / InitialCost(problem), 1, 1e-9) << noise << " " << frames;
      EXPECT_LT(report.final_cost, 0.5 * report.initial_cost);
      EXPECT_NEAR(Solve(&problem, ChainEngine(1)).final_cost / report.final_cost, 1, 1e-5) << noise << " " << frames;
    }
  }
}

TEST(Peers, AutoDiffRefusesWhatItDoesNotState) {
  const auto work = Problem(2, "pixel");
  work->problem.frames[1].Get<UprightTerm>().weight = 1;
  SequenceProblem problem = work->problem;
  EXPECT_THROW(SolveWithAutoDiff(&problem, {}), std::invalid_argument);
}

TEST(Peers, PyTorchStatesTheSameCost) {
  if (std::system("/usr/bin/python3 -c 'import torch' >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "/usr/bin/python3 has no torch (package python3-torch)";
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / Concatenate("bodyloom_peer_", ::getpid());
  std::filesystem::create_directories(folder);
  const auto work = Problem(4, "densepose");
  const std::string problem = folder / "problem.npz", answer = folder / "answer.npz";
  WriteProblemFile(*work, problem);
  for (const std::string method : {"adam --rate 0.02", "lbfgs --rate 1"}) {
    const std::string call = "/usr/bin/python3 " + SourceDir() + "/benchmarks/peers/pytorch_fit.py " + problem + " " +
                             answer + " --threads 1 --iterations 20 --method " + method;
    ASSERT_EQ(std::system(call.c_str()), 0) << call;
    const std::vector<double> cost = RequireArray(ReadNpz(answer), "cost", answer).ToDoubles();
    const double initial = InitialCost(work->problem);
    EXPECT_NEAR(cost.front() / initial, 1, 1e-4) << method;  // float32
    EXPECT_LT(cost.back(), 0.9 * initial) << method;
    const std::vector<PeerMoment> moments = ReadPeerFile(*work, answer);
    ASSERT_EQ(moments.size(), cost.size());
    EXPECT_GT(moments.back().seconds, moments.front().seconds);
    EXPECT_EQ(moments.back().iterations, 20);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace bodyloom::peer_test
