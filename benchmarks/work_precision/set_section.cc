// SPDX-License-Identifier: Apache-2.0
/// 48 problems: how often each engine is how many times slower than the fastest, and whether final costs agree.
#include <algorithm>
#include <cmath>

#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/work_precision/sections.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

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

/// The engine goes on from its answer until the cost no longer changes.
EngineRun Finish(const EngineRun& run, Engine engine) {
  engine.options.function_tolerance = 1e-14;
  engine.options.max_iterations = 10000;
  EngineRun finished;
  finished.answer = run.answer;
  const SolveReport report = engine.solve(&finished.answer, engine.options);
  finished.cost = report.final_cost;
  finished.iterations = run.iterations + report.iterations;
  return finished;
}

/// Relative decrease of this cost by the other engine; nearly 0 at a minimum.
double Gain(const EngineRun& run, const Engine& other) {
  const EngineRun finished = Finish(run, other);
  return (run.cost - finished.cost) / run.cost;
}

/// Explains unequal costs: a valley that was not followed to its end, or two minima.
std::string Explain(const std::string& name, const Engine& ceres, const Engine& chain, const EngineRun& a,
                    const EngineRun& b) {
  const auto gap = [](const EngineRun& x, const EngineRun& y) { return (y.cost - x.cost) / std::min(x.cost, y.cost); };
  const EngineRun a_end = Finish(a, ceres), b_end = Finish(b, chain);
  const double end = gap(a_end, b_end);
  std::string text = Concatenate("set, ", name, ": chain's cost over Ceres' ", BenchNumber(gap(a, b)), " after ",
                                 b.iterations, " and ", a.iterations, " iterations; at the end of the valley (",
                                 b_end.iterations, " and ", a_end.iterations, ") ", BenchNumber(end));
  if (std::abs(end) <= kEqual) return text + ": the same minimum";
  return Concatenate(text, ", joints up to ", BenchNumber(LargestAngleDeg(a_end.answer, b_end.answer)),
                     " degrees apart; from the other's end Ceres gains ", BenchNumber(Gain(b_end, ceres)), ", chain ",
                     BenchNumber(Gain(a_end, chain)), " (0: another minimum)");
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
