// SPDX-License-Identifier: Apache-2.0
/// 48 problems: how often each engine is how many times slower than the fastest, and whether final costs agree.
#include <algorithm>
#include <cmath>

#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/work_precision/sections.h"
#include "geometry/check.h"
#include "geometry/rotation.h"

namespace bodyloom {
namespace {

constexpr double kSolved = 1e-4;  ///< cost within this share of the lowest found
constexpr double kEqual = 1e-6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double LargestAngleDeg(const SequenceProblem& a, const SequenceProblem& b) {
  double largest = 0;
  for (size_t t = 0; t < a.states.size(); ++t) {
    for (size_t j = 0; j < a.states[t].rotations.size(); ++j) {
      largest = std::max(largest, RotationAngleBetween(a.states[t].rotations[j], b.states[t].rotations[j]));
    }
  }
  return largest * 180 / M_PI;
}

/// How far the other engine gets from this answer, as a share of its cost: next to nothing at a minimum.
double Polish(const EngineRun& run, Engine other) {
  SequenceProblem problem = run.answer;
  other.options.function_tolerance = 1e-12;
  const SolveReport report = other.solve(&problem, other.options);
  return (run.cost - report.final_cost) / run.cost;
}

/// Why costs that are not equal are not: two minima, or a solve that stopped early.
std::string Explain(const std::string& name, const Engine& ceres, const Engine& chain, const EngineRun& a,
                    const EngineRun& b) {
  const double gap = (b.cost - a.cost) / std::min(a.cost, b.cost);
  const double of_ceres = Polish(a, chain), of_chain = Polish(b, ceres);
  const bool minima = of_ceres < kEqual && of_chain < kEqual;
  return Concatenate("set, ", name, ": chain's cost is ", std::abs(gap), gap > 0 ? " higher" : " lower",
                     " than Ceres'; started at the other's answer Ceres gains ", of_chain, ", chain gains ", of_ceres,
                     "; joints differ by up to ", LargestAngleDeg(a.answer, b.answer),
                     " degrees: ", minima ? "two minima" : "a solve that stopped before its minimum");
}

}  // namespace

void SetSection(WorkBench* bench) {
  std::vector<Engine> engines = {CeresEngine(bench->threads), ChainEngine(bench->threads)};
  if (bench->arguments.Integer("set_autodiff") != 0) engines.push_back(AutoDiffEngine(bench->threads));
  for (Engine& engine : engines) {
    engine.options.max_iterations = 300;
    // Costs must be equal to 1e-6; a peer may stop as soon as 1e-4 is safe.
    engine.options.function_tolerance = engine.name == "ceres AutoDiff" ? 1e-7 : 1e-9;
  }
  std::vector<std::vector<double>> factors(engines.size());
  double worst = 0;
  int count = 0, equal = 0;
  for (const std::string& motion : bench->arguments.List("motions")) {
    for (const std::string noise : {"pixel", "densepose"}) {
      for (int dense : {50, 300}) {
        for (int frames : {1, 5, 20}) {
          for (int seed : {1, 2}) {
            WorkProblemOptions options = bench->Options(frames, dense);
            options.motion = motion;
            options.noise = noise;
            options.seed = seed;
            options.first_frame = 40 * seed;
            const auto work = MakeWorkProblem(options);
            const std::string name = Concatenate(MotionName(motion), " ", noise, " noise, ", dense, " keypoints, ",
                                                 frames, " frames, seed ", seed);
            const auto runs = MeasureEngines(*work, engines, 1);
            bench->Add("set", name, engines, runs, BoundPx(*work));
            const double low = std::min(runs[0].cost, runs[1].cost), high = std::max(runs[0].cost, runs[1].cost);
            const bool same = (high - low) <= kEqual * low;
            worst = std::max(worst, (high - low) / low);
            equal += same;
            ++count;
            if (!same) bench->report.notes.push_back(Explain(name, engines[0], engines[1], runs[0], runs[1]));
            double best = kInfinity, fastest = kInfinity;
            for (const EngineRun& run : runs) best = std::fmin(best, run.cost);
            const auto solved = [&](const EngineRun& run) { return run.cost <= best * (1 + kSolved); };
            for (const EngineRun& run : runs) fastest = solved(run) ? std::min(fastest, run.cpu.median) : fastest;
            for (size_t i = 0; i < runs.size(); ++i) {
              factors[i].push_back(solved(runs[i]) ? runs[i].cpu.median / fastest : kInfinity);
            }
          }
        }
      }
    }
  }
  double slowest = 1;
  for (const auto& list : factors) {
    for (double factor : list) slowest = std::isfinite(factor) ? std::max(slowest, factor) : slowest;
  }
  Plot plot{"work_precision_profile",
            Concatenate(count, " problems: share solved within a factor of the fastest"),
            "processor time over the fastest engine's",
            "share of problems",
            true,
            false,
            {}};
  for (size_t i = 0; i < engines.size(); ++i) {
    std::sort(factors[i].begin(), factors[i].end());
    PlotLine line{engines[i].name, {}, false, true};
    for (size_t k = 0; k < factors[i].size(); ++k) {
      if (std::isfinite(factors[i][k])) line.points.emplace_back(factors[i][k], double(k + 1) / double(count));
    }
    const auto solved = line.points.size();
    line.points.emplace_back(1.2 * slowest, double(solved) / double(count));
    plot.lines.push_back(line);
    bench->report.notes.push_back(Concatenate("set: ", engines[i].name, " solves ", solved, " of ", count,
                                              " problems to within 1e-4 of the lowest cost, median factor ",
                                              factors[i][factors[i].size() / 2]));
  }
  bench->report.notes.push_back(Concatenate("set: final costs of chain and Ceres agree to 1e-6 on ", equal, " of ",
                                            count, " problems, largest relative difference ", worst));
  bench->report.plots.push_back(plot);
}

}  // namespace bodyloom
