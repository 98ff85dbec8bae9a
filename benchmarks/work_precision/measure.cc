// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/measure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <utility>

#include "benchmarks/accuracy/dense_bound.h"
#include "benchmarks/work_precision/autodiff_peer.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/geometry/base/stopwatch.h"

namespace bodyloom {

Engine ChainEngine(int threads, int early_dense) {
  Engine engine{early_dense > 0 ? "chain, early points" : "chain", {}};
  engine.options.solver = SequenceSolver::kChain;
  engine.options.num_threads = threads;
  engine.options.chain.early_dense = early_dense;
  return engine;
}

Engine ReusingEngine(int threads) {
  Engine engine = ChainEngine(threads, 0);
  engine.name = "chain, reused linearisation";
  engine.options.chain.reuse_linearisation = kTrackerReuse;
  return engine;
}

Engine FreezingEngine(int threads) {
  Engine engine = ReusingEngine(threads);
  engine.name = "chain, reused and frozen frames";
  engine.options.chain.frozen_share = kTrackerFrozenShare;
  return engine;
}

Engine TrackerEngine(int threads) {
  Engine engine = FreezingEngine(threads);
  engine.name = "chain, as the tracker";
  engine.options.chain.early_dense = kTrackerEarlyDense;
  return engine;
}

Engine CeresEngine(int threads) {
  Engine engine{"ceres", {}};
  engine.options.num_threads = threads;
  return engine;
}

Engine AutoDiffEngine(int threads) {
  Engine engine{"ceres AutoDiff", {}};
  engine.options.num_threads = threads;
  engine.solve = SolveWithAutoDiff;
  return engine;
}

TimeMs TimeMs::Of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  TimeMs time;
  if (values.empty()) return time;
  time.median = values[values.size() / 2];
  if (values.size() > 1) time.spread_percent = 50 * (values.back() - values.front()) / time.median;
  return time;
}

std::vector<EngineRun> MeasureEngines(const WorkProblem& work, const std::vector<Engine>& engines, int repeat) {
  std::vector<EngineRun> runs(engines.size());
  std::vector<std::vector<double>> wall(engines.size()), cpu(engines.size());
  const auto T = static_cast<double>(work.problem.states.size());
  for (int round = 0; round < repeat; ++round) {
    for (size_t i = 0; i < engines.size(); ++i) {
      SequenceProblem problem = work.problem;
      const std::clock_t start = std::clock();
      const SolveReport report = engines[i].solve(&problem, engines[i].options);
      cpu[i].push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / T);
      wall[i].push_back(1e3 * report.seconds / T);
      if (round > 0) continue;
      runs[i].iterations = report.iterations;
      if (report.status != SolveStatus::kFailure) runs[i].cost = report.final_cost;
      runs[i].error_px = ProjectionErrorPx(work, problem.states, problem.betas);
      runs[i].answer = std::move(problem);
    }
  }
  for (size_t i = 0; i < engines.size(); ++i) {
    runs[i].wall = TimeMs::Of(wall[i]);
    runs[i].cpu = TimeMs::Of(cpu[i]);
  }
  return runs;
}

Timing MeasureAction(const std::function<void()>& action, int repeat, double divisor) {
  std::vector<double> wall, cpu;
  for (int round = 0; round < repeat; ++round) {
    const std::clock_t cpu_start = std::clock();
    const Stopwatch watch;
    action();
    wall.push_back(1e3 * watch.seconds() / divisor);
    cpu.push_back(1e3 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC / divisor);
  }
  return {TimeMs::Of(wall), TimeMs::Of(cpu)};
}

double BoundPx(const WorkProblem& work) {
  DenseBoundOptions options;
  options.smooth = work.problem.states.size() > 2;
  return DenseBound(BuiltinBody(), work.clip, options).mean_px;
}

double PeakMegabytes() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void ResetPeak() { std::ofstream("/proc/self/clear_refs") << "5"; }

WorkProblemOptions WorkBench::Options(int frames, int dense) const {
  WorkProblemOptions options;
  options.motion = arguments.List("motions")[0];
  options.frames = frames;
  options.dense = dense;
  return options;
}

void WorkBench::AddRow(const std::string& group, const std::string& problem, const std::string& engine,
                       std::vector<double> values) {
  values.resize(kWorkColumns.size(), std::numeric_limits<double>::quiet_NaN());
  std::fprintf(stderr, "%s, %s, %s: %s ms wall, %s ms processor, error %s\n", group.c_str(), problem.c_str(),
               engine.c_str(), BenchNumber(values[0]).c_str(), BenchNumber(values[2]).c_str(),
               BenchNumber(values[5]).c_str());
  report.rows.push_back({group, {problem, engine}, std::move(values)});
}

void WorkBench::Add(const std::string& group, const std::string& problem, const std::vector<Engine>& engines,
                    const std::vector<EngineRun>& runs, double bound_px, double peak_mb) {
  double best = std::numeric_limits<double>::infinity();
  for (const EngineRun& run : runs) best = std::fmin(best, run.cost);
  for (size_t i = 0; i < runs.size(); ++i) {
    const EngineRun& run = runs[i];
    AddRow(group, problem, engines[i].name,
           {run.wall.median, run.wall.spread_percent, run.cpu.median, run.cpu.spread_percent, double(run.iterations),
            run.error_px, bound_px, run.cost / best - 1, peak_mb});
  }
}

}  // namespace bodyloom
