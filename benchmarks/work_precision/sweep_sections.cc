// SPDX-License-Identifier: Apache-2.0
/// Error against time of the sequence solve: over tolerances, numbers of keypoints, lengths and threads.
#include <algorithm>

#include "benchmarks/work_precision/sections.h"
#include "geometry/base/check.h"
#include "tracking/problem/frame_cost.h"

namespace bodyloom {

void ToleranceSection(WorkBench* bench) {
  const auto work = MakeWorkProblem(bench->Options(100, 300));
  const double bound = BoundPx(*work);
  Plot plot{"work_precision_tolerance",
            "100 frames, 300 keypoints: tolerance 1e-1 to 1e-7",
            "processor time, ms a frame",
            "mean error, px at 512",
            true,
            true,
            {}};
  std::vector<Engine> engines = {CeresEngine(bench->threads), ChainEngine(bench->threads)};
  for (const Engine& engine : engines) plot.lines.push_back({engine.name, {}});
  for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7}) {
    for (Engine& engine : engines) engine.options.function_tolerance = tolerance;
    const auto runs = MeasureEngines(*work, engines, bench->repeat);
    bench->Add("function tolerance", Concatenate(tolerance), engines, runs, bound);
    for (size_t i = 0; i < runs.size(); ++i) plot.lines[i].points.emplace_back(runs[i].cpu.median, runs[i].error_px);
  }
  plot.lines.push_back(
      {"Cramér–Rao", {{plot.lines[1].points[0].first, bound}, {plot.lines[0].points.back().first, bound}}, true});
  bench->report.plots.push_back(plot);
}

void CountSection(WorkBench* bench) {
  Plot time{
      "work_precision_counts_time", "50 frames", "keypoints a frame", "processor time, ms a frame", true, true, {}};
  Plot error{"work_precision_counts_error",
             "50 frames",
             "keypoints a frame",
             "mean error, px at 512",
             true,
             true,
             {{"chain", {}}, {"Cramér–Rao", {}, true}}};
  const std::vector<Engine> engines = {CeresEngine(bench->threads), ChainEngine(bench->threads),
                                       ChainEngine(bench->threads, 300), TrackerEngine(bench->threads)};
  for (const Engine& engine : engines) time.lines.push_back({engine.name, {}});
  for (int dense : {20, 100, 300, 1000, 5000}) {
    const auto work = MakeWorkProblem(bench->Options(50, dense));
    const double bound = BoundPx(*work);
    const auto runs = MeasureEngines(*work, engines, bench->repeat);
    bench->Add("keypoints a frame", std::to_string(dense), engines, runs, bound);
    for (size_t i = 0; i < runs.size(); ++i) time.lines[i].points.emplace_back(dense, runs[i].cpu.median);
    error.lines[0].points.emplace_back(dense, runs[1].error_px);
    error.lines[1].points.emplace_back(dense, bound);
  }
  bench->report.plots.push_back(time);
  bench->report.plots.push_back(error);
}

void EvaluationSection(WorkBench* bench) {
  FrameEvaluator evaluator;
  FrameSystem system;
  for (int dense : {20, 100, 300, 1000, 5000}) {
    const auto work = MakeWorkProblem(bench->Options(50, dense));
    const SequenceProblem& problem = work->problem;
    const int rounds = std::max(1, 10000 / dense);
    for (const bool derivatives : {false, true}) {
      const auto evaluate_all = [&]() {
        for (int round = 0; round < rounds; ++round) {
          for (size_t t = 0; t < problem.frames.size(); ++t) {
            evaluator.Evaluate(problem.layout, problem.frames[t], problem.states[t], problem, derivatives, &system);
          }
        }
      };
      evaluate_all();  // the first one fills scratch memory
      const Timing timing = MeasureAction(evaluate_all, bench->repeat, rounds * double(problem.frames.size()));
      bench->AddRow("one evaluation", std::to_string(dense), derivatives ? "cost, gradient and matrix" : "cost",
                    {timing.wall.median, timing.wall.spread_percent, timing.cpu.median, timing.cpu.spread_percent});
    }
  }
}

void LengthSection(WorkBench* bench) {
  Plot time{"work_precision_lengths", "300 keypoints a frame", "frames", "processor time, ms a frame", true, true, {}};
  Plot memory{
      "work_precision_memory", "300 keypoints a frame", "frames", "peak memory of the solve, MB", true, true, {}};
  const std::vector<Engine> engines = {CeresEngine(bench->threads), ChainEngine(bench->threads),
                                       ReusingEngine(bench->threads), FreezingEngine(bench->threads)};
  for (const Engine& engine : engines) {
    time.lines.push_back({engine.name, {}});
    memory.lines.push_back({engine.name, {}});
  }
  for (const std::string& text : bench->arguments.List("lengths")) {
    const int frames = std::stoi(text);
    const auto work = MakeWorkProblem(bench->Options(frames, 300));
    for (size_t e = frames > 1000 ? 1 : 0; e < engines.size(); ++e) {  // minutes with Ceres
      ResetPeak();
      const double before = PeakMegabytes();
      const auto runs = MeasureEngines(*work, {engines[e]}, frames > 2000 ? 1 : bench->repeat);
      const double peak = PeakMegabytes() - before;
      bench->Add("frames", text, {engines[e]}, runs,
                 frames <= 200 ? BoundPx(*work) : std::numeric_limits<double>::quiet_NaN(), peak);
      time.lines[e].points.emplace_back(frames, runs[0].cpu.median);
      memory.lines[e].points.emplace_back(frames, peak);
    }
  }
  bench->report.plots.push_back(time);
  bench->report.plots.push_back(memory);
}

void ThreadSection(WorkBench* bench) {
  const auto work = MakeWorkProblem(bench->Options(100, 300));
  for (int threads : {1, 2, 4}) {
    const std::vector<Engine> engines = {CeresEngine(threads), ChainEngine(threads)};
    bench->Add("threads", std::to_string(threads), engines, MeasureEngines(*work, engines, bench->repeat),
               std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace bodyloom
