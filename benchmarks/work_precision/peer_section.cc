// SPDX-License-Identifier: Apache-2.0
/// Alternatives of a user on the same problems: Ceres with automatic derivatives, and PyTorch.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/work_precision/sections.h"
#include "benchmarks/work_precision/work_problem.h"
#include "geometry/base/check.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/paths.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// One way to run the script.
struct TorchSetting {
  std::string name, options;
  /// "adam:0.02:300" or "lbfgs:1:100": method, rate, iterations.
  static TorchSetting Parse(const std::string& text) {
    const size_t first = text.find(':'), second = text.find(':', first + 1);
    BODYLOOM_CHECK(second != std::string::npos, "--pytorch '", text, "', expected method:rate:iterations");
    const std::string method = text.substr(0, first), rate = text.substr(first + 1, second - first - 1);
    const bool adam = method == "adam";
    return {Concatenate("PyTorch ", adam ? "Adam " : "L-BFGS ", rate),
            Concatenate("--method ", method, " --rate ", rate, adam ? " --decay" : "", " --iterations ",
                        text.substr(second + 1))};
  }
};

/// The cost of this state by the C++ engines.
double CostOf(const SequenceProblem& answer) {
  SequenceProblem judged = answer;
  SolveOptions judge;
  judge.max_iterations = 1;
  return SolveSequence(&judged, judge).initial_cost;
}

/// Time until the error is at most chain's, ms per frame (infinity: never), and the error then (else the minimum).
struct Reached {
  double wall_ms = std::numeric_limits<double>::infinity(), cpu_ms = wall_ms, error_px = wall_ms;
  int iterations = 0;
};

class PeerProblem {
 public:
  PeerProblem(WorkBench* bench, int frames)
      : bench_(bench),
        frames_(frames),
        group_(Concatenate("peers, ", frames, frames == 1 ? " frame" : " frames")),
        work_(MakeWorkProblem(bench->Options(frames, 300))),
        bound_(BoundPx(*work_)) {
    plot_ = {Concatenate("work_precision_peers_", frames),
             Concatenate(frames, frames == 1 ? " frame" : " frames", ", 300 keypoints"),
             "wall time, ms a frame",
             "mean error, px at 512",
             true,
             true,
             {}};
  }

  void Run() {
    std::vector<Engine> engines = {CeresEngine(bench_->threads), ChainEngine(bench_->threads)};
    auto runs = MeasureEngines(*work_, engines, bench_->repeat);
    if (frames_ <= bench_->arguments.Integer("autodiff_frames")) {
      engines.push_back(AutoDiffEngine(bench_->threads));
      runs.push_back(MeasureEngines(*work_, {engines.back()}, 1)[0]);
    } else {
      bench_->report.notes.push_back(group_ + ": Ceres AutoDiff not run (--autodiff_frames)");
    }
    bench_->Add(group_, "to convergence", engines, runs, bound_);
    chain_ = runs[1];
    best_cost_ = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < runs.size(); ++i) {
      plot_.lines.push_back({engines[i].name, {{runs[i].wall.median, runs[i].error_px}}});
      best_cost_ = std::fmin(best_cost_, runs[i].cost);
      slowest_ = std::max(slowest_, runs[i].wall.median);
      Compare(engines[i].name, {runs[i].wall.median, runs[i].cpu.median, runs[i].error_px, runs[i].iterations});
    }
    Torch();
    plot_.lines.push_back({"Cramér–Rao", {{chain_.wall.median, bound_}, {slowest_, bound_}}, true});
    bench_->report.plots.push_back(plot_);
  }

 private:
  /// A row of "peers": what it took the peer to be as good as chain, or the best it became.
  void Compare(const std::string& peer, const Reached& reached) {
    const bool good = std::isfinite(reached.wall_ms);
    bench_->AddRow("peers", Concatenate(frames_, frames_ == 1 ? " frame" : " frames", good ? "" : ", never as good"),
                   peer,
                   {good ? reached.wall_ms : kNaN, kNaN, good ? reached.cpu_ms : kNaN, kNaN, double(reached.iterations),
                    reached.error_px, bound_, kNaN, kNaN, good ? reached.wall_ms / chain_.wall.median : kNaN});
  }

  void Torch() {
    const std::vector<std::string> settings = bench_->arguments.List("pytorch");
    if (settings.empty()) return;
    if (std::system("/usr/bin/python3 -c 'import torch' >/dev/null 2>&1") != 0) {
      bench_->report.notes.push_back("PyTorch: left out, /usr/bin/python3 has no torch (package python3-torch)");
      return;
    }
    const TemporaryFolder folder;
    const std::string problem_path = folder.File("problem.npz"), answer_path = folder.File("answer.npz");
    WriteProblemFile(*work_, problem_path);
    for (const std::string& text : settings) {
      const TorchSetting setting = TorchSetting::Parse(text);
      const std::string call =
          Concatenate("/usr/bin/python3 ", SourceDir(), "/benchmarks/peers/pytorch_fit.py ", problem_path, " ",
                      answer_path, " ", setting.options, " --threads ", bench_->threads);
      if (std::system(call.c_str()) != 0) {
        bench_->report.notes.push_back("PyTorch: failed: " + setting.options);
        continue;
      }
      PlotLine line{setting.name, {}};
      Reached reached;
      for (const PeerMoment& moment : ReadPeerFile(*work_, answer_path)) {
        const double wall = 1e3 * moment.seconds / frames_, cpu = 1e3 * moment.cpu_seconds / frames_;
        const double error = ProjectionErrorPx(*work_, moment.answer.states, moment.answer.betas);
        line.points.emplace_back(wall, error);
        slowest_ = std::max(slowest_, wall);
        if (!std::isfinite(reached.wall_ms) && error < reached.error_px) {
          reached.error_px = error;
          reached.iterations = moment.iterations;
          if (error <= chain_.error_px) reached.wall_ms = wall, reached.cpu_ms = cpu;
        }
        bench_->AddRow(group_, Concatenate("after ", moment.iterations), setting.name,
                       {wall, kNaN, cpu, kNaN, double(moment.iterations), error, bound_,
                        CostOf(moment.answer) / best_cost_ - 1, kNaN});
      }
      plot_.lines.push_back(line);
      Compare(setting.name, reached);
    }
  }

  WorkBench* bench_;
  int frames_;
  std::string group_;
  std::unique_ptr<WorkProblem> work_;
  double bound_, best_cost_ = 0, slowest_ = 0;
  EngineRun chain_;
  Plot plot_;
};

}  // namespace

void PeerSection(WorkBench* bench) {
  for (const std::string& frames : bench->arguments.List("peer_frames")) PeerProblem(bench, std::stoi(frames)).Run();
}

}  // namespace bodyloom
