// SPDX-License-Identifier: Apache-2.0
/// Error against time of the sequence solve: its engines and a PyTorch fit on the same problems, in one run.
///
///   bodyloom_bench_work_precision [--sections set,tolerance,counts,lengths,threads,pytorch] [--threads 2] [--repeat 3]
///                                 [--pytorch_frames 1,20] [--plots DIR] [--json F]
///
/// Time is given twice: wall, and processor time of the process, which a busy machine disturbs less. Each is the median
/// over `repeat` solves, engines taking turns. cost/best: final cost over the lowest that any engine found on the
/// problem.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_bound.h"
#include "benchmarks/work_precision/plot_svg.h"
#include "benchmarks/work_precision/problem_file.h"
#include "data_tools/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/check.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Engine {
  std::string name;
  SolveOptions options;
};

struct Run {
  double wall_ms = kNaN, cpu_ms = kNaN;  ///< a frame
  double cost = kNaN, error_px = kNaN;
  int iterations = 0;
};

Engine Chain(int threads, int early_dense = 0) {
  Engine engine{early_dense > 0 ? "chain, early points" : "chain", {}};
  engine.options.solver = SequenceSolver::kChain;
  engine.options.num_threads = threads;
  engine.options.early_dense = early_dense;
  return engine;
}

Engine Ceres(int threads) {
  Engine engine{"ceres", {}};
  engine.options.num_threads = threads;
  return engine;
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// All engines on one problem, taking turns.
std::vector<Run> Measure(const WorkProblem& work, const std::vector<Engine>& engines, int repeat) {
  std::vector<Run> runs(engines.size());
  std::vector<std::vector<double>> wall(engines.size()), cpu(engines.size());
  const auto T = static_cast<double>(work.problem.states.size());
  for (int round = 0; round < repeat; ++round) {
    for (size_t i = 0; i < engines.size(); ++i) {
      SequenceProblem problem = work.problem;
      const std::clock_t start = std::clock();
      const SolveReport report = SolveSequence(&problem, engines[i].options);
      cpu[i].push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / T);
      wall[i].push_back(1e3 * report.seconds / T);
      runs[i].iterations = report.iterations;
      runs[i].cost = report.status == SolveStatus::kFailure ? kNaN : report.final_cost;
      if (round == 0) runs[i].error_px = ProjectionErrorPx(work, problem.states, problem.betas);
    }
  }
  for (size_t i = 0; i < engines.size(); ++i) {
    runs[i].wall_ms = Median(wall[i]);
    runs[i].cpu_ms = Median(cpu[i]);
  }
  return runs;
}

double BoundPx(const WorkProblem& work) {
  DenseBoundOptions options;
  options.smooth = work.problem.states.size() > 2;
  return DenseBound(BuiltinBody(), work.clip, options).mean_px;
}

/// Highest memory of the process since the last reset, MB.
double PeakMegabytes() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  }
  return kNaN;
}
void ResetPeak() { std::ofstream("/proc/self/clear_refs") << "5"; }

class Bench {
 public:
  Bench(const BenchArguments& arguments, std::string command) : arguments_(arguments) {
    report_.title = "Run time against error of the sequence solve";
    report_.command = std::move(command);
    report_.label_columns = {"problem", "engine"};
    report_.value_columns = {"wall_ms_per_frame", "cpu_ms_per_frame", "iterations", "error_px",
                             "bound_px",          "cost_over_best",   "peak_mb"};
    report_.summarise = false;
    report_.notes = {"times: medians, wall and processor time of the process", "error: mean projection, pixels at 512"};
    threads_ = arguments.Integer("threads");
    repeat_ = arguments.Integer("repeat");
  }

  void Run() {
    for (const std::string& section : arguments_.List("sections")) {
      if (section == "set")
        ProblemSet();
      else if (section == "tolerance")
        Tolerances();
      else if (section == "counts")
        Counts();
      else if (section == "lengths")
        Lengths();
      else if (section == "threads")
        Threads();
      else if (section == "pytorch")
        PyTorch();
      else
        BODYLOOM_CHECK(false, "--sections names '", section, "'");
    }
    HandOver(report_, arguments_.Text("json"));
  }

 private:
  [[nodiscard]] WorkProblemOptions Options(int frames, int dense) const {
    WorkProblemOptions options;
    options.motion = arguments_.List("motions")[0];
    options.frames = frames;
    options.dense = dense;
    return options;
  }

  void Add(const std::string& group, const std::string& problem, const std::vector<Engine>& engines,
           const std::vector<bodyloom::Run>& runs, double bound, double peak = kNaN) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& run : runs) best = std::min(best, std::isfinite(run.cost) ? run.cost : best);
    for (size_t i = 0; i < runs.size(); ++i) {
      report_.rows.push_back({group,
                              {problem, engines[i].name},
                              {runs[i].wall_ms, runs[i].cpu_ms, double(runs[i].iterations), runs[i].error_px, bound,
                               runs[i].cost / best, peak}});
      std::fprintf(stderr, "%s, %s, %s: %.3f ms wall, %.3f ms processor, %.3f px, cost/best %.8f\n", group.c_str(),
                   problem.c_str(), engines[i].name.c_str(), runs[i].wall_ms, runs[i].cpu_ms, runs[i].error_px,
                   runs[i].cost / best);
    }
  }

  void Save(const Plot& plot, const std::string& name) const {
    const std::string& folder = arguments_.Text("plots");
    if (!folder.empty()) WriteFileAtomically(folder + "/" + name + ".svg", PlotSvg(plot));
  }

  /// 48 problems; a performance profile: for each factor, the share of problems that an engine solves within that
  /// factor of the fastest. Solved: a cost within 1e-4 of the lowest found.
  void ProblemSet() {
    std::vector<Engine> engines = {Ceres(threads_), Chain(threads_)};
    for (Engine& engine : engines) {
      engine.options.max_iterations = 200;
      engine.options.function_tolerance = 1e-9;
    }
    std::vector<std::vector<double>> factors(engines.size());
    double worst = 0;
    int count = 0, equal = 0;
    for (const std::string& motion : arguments_.List("motions")) {
      for (const std::string noise : {"pixel", "densepose"}) {
        for (int dense : {50, 300}) {
          for (int frames : {1, 5, 20}) {
            for (int seed : {1, 2}) {
              WorkProblemOptions options = Options(frames, dense);
              options.motion = motion;
              options.noise = noise;
              options.seed = seed;
              options.first_frame = 40 * seed;
              const auto work = MakeWorkProblem(options);
              const auto runs = Measure(*work, engines, 1);
              double best = std::numeric_limits<double>::infinity(), fastest = best;
              const double low = std::min(runs[0].cost, runs[1].cost), high = std::max(runs[0].cost, runs[1].cost);
              worst = std::max(worst, (high - low) / low);
              equal += (high - low) <= 1e-6 * low;
              ++count;
              for (const auto& run : runs) best = std::min(best, std::isfinite(run.cost) ? run.cost : best);
              for (const auto& run : runs) {
                if (run.cost <= best * (1 + 1e-4)) fastest = std::min(fastest, run.cpu_ms);
              }
              for (size_t i = 0; i < runs.size(); ++i) {
                factors[i].push_back(runs[i].cost <= best * (1 + 1e-4) ? runs[i].cpu_ms / fastest
                                                                       : std::numeric_limits<double>::infinity());
              }
            }
          }
        }
      }
    }
    Plot plot{"Share of problems solved within a factor of the fastest",
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
      line.points.emplace_back(20.0, double(solved) / double(count));
      plot.lines.push_back(line);
      report_.notes.push_back(Concatenate("set: ", engines[i].name, " solves ", solved, " of ", count,
                                          " problems, median factor ", Median(factors[i])));
    }
    report_.notes.push_back(Concatenate("set: final costs agree to 1e-6 on ", equal, " of ", count,
                                        " problems, largest relative difference ", worst));
    Save(plot, "work_precision_profile");
  }

  void Tolerances() {
    const auto work = MakeWorkProblem(Options(100, 300));
    const double bound = BoundPx(*work);
    Plot plot{"100 frames, 300 keypoints", "processor time, ms a frame", "mean error, px at 512", true, true, {}};
    std::vector<Engine> engines = {Ceres(threads_), Chain(threads_)};
    for (const Engine& engine : engines) plot.lines.push_back({engine.name, {}});
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7}) {
      for (Engine& engine : engines) engine.options.function_tolerance = tolerance;
      const auto runs = Measure(*work, engines, repeat_);
      Add("function tolerance", Concatenate("tolerance ", tolerance), engines, runs, bound);
      for (size_t i = 0; i < runs.size(); ++i) plot.lines[i].points.emplace_back(runs[i].cpu_ms, runs[i].error_px);
    }
    plot.lines.push_back(
        {"Cramér–Rao", {{plot.lines[1].points[0].first, bound}, {plot.lines[0].points.back().first, bound}}, true});
    Save(plot, "work_precision_tolerance");
  }

  void Counts() {
    Plot time{"50 frames", "keypoints a frame", "processor time, ms a frame", true, true, {}};
    Plot error{"50 frames",
               "keypoints a frame",
               "mean error, px at 512",
               true,
               true,
               {{"chain", {}}, {"Cramér–Rao", {}, true}}};
    const std::vector<Engine> engines = {Ceres(threads_), Chain(threads_), Chain(threads_, 300)};
    for (const Engine& engine : engines) time.lines.push_back({engine.name, {}});
    for (int dense : {20, 100, 300, 1000, 5000}) {
      const auto work = MakeWorkProblem(Options(50, dense));
      const double bound = BoundPx(*work);
      const auto runs = Measure(*work, engines, repeat_);
      Add("keypoints a frame", std::to_string(dense), engines, runs, bound);
      for (size_t i = 0; i < runs.size(); ++i) time.lines[i].points.emplace_back(dense, runs[i].cpu_ms);
      error.lines[0].points.emplace_back(dense, runs[1].error_px);
      error.lines[1].points.emplace_back(dense, bound);
    }
    Save(time, "work_precision_counts_time");
    Save(error, "work_precision_counts_error");
  }

  void Lengths() {
    Plot plot{"300 keypoints a frame", "frames", "processor time, ms a frame", true, true, {}};
    for (const char* name : {"ceres", "chain"}) plot.lines.push_back({name, {}});
    for (const std::string& text : arguments_.List("lengths")) {
      const int frames = std::stoi(text);
      const auto work = MakeWorkProblem(Options(frames, 300));
      for (const Engine& engine : {Ceres(threads_), Chain(threads_)}) {
        const bool is_chain = engine.name == "chain";
        if (!is_chain && frames > 1000) continue;
        ResetPeak();
        const double before = PeakMegabytes();
        const auto runs = Measure(*work, {engine}, frames > 200 ? 1 : repeat_);
        Add("frames", text, {engine}, runs, kNaN, PeakMegabytes() - before);
        plot.lines[is_chain].points.emplace_back(frames, runs[0].cpu_ms);
      }
    }
    Save(plot, "work_precision_lengths");
  }

  void Threads() {
    const auto work = MakeWorkProblem(Options(100, 300));
    for (int threads : {1, 2}) {
      const std::vector<Engine> engines = {Ceres(threads), Chain(threads)};
      Add("threads", std::to_string(threads), engines, Measure(*work, engines, repeat_), kNaN);
    }
  }

  void PyTorch() {
    const std::string script = BODYLOOM_SOURCE_DIR "/benchmarks/peers/pytorch_fit.py";
    if (std::system("/usr/bin/python3 -c 'import torch' >/dev/null 2>&1") != 0) {
      report_.notes.push_back("pytorch: skipped, /usr/bin/python3 has no torch (package python3-torch)");
      return;
    }
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "bodyloom_work_precision";
    std::filesystem::create_directories(folder);
    for (const std::string& text : arguments_.List("pytorch_frames")) {
      const int frames = std::stoi(text);
      const auto work = MakeWorkProblem(Options(frames, 300));
      const double bound = BoundPx(*work);
      const std::string problem_path = folder / ("problem_" + text + ".npz"), answer_path = folder / "answer.npz";
      WriteProblemFile(*work, problem_path);
      Plot plot{text + (frames == 1 ? " frame" : " frames") + ", 300 keypoints",
                "wall time, ms a frame",
                "mean error, px at 512",
                true,
                true,
                {}};
      const std::vector<Engine> engines = {Ceres(threads_), Chain(threads_)};
      const auto runs = Measure(*work, engines, repeat_);
      Add("peers, " + text + " frames", "to convergence", engines, runs, bound);
      for (size_t i = 0; i < runs.size(); ++i) {
        plot.lines.push_back({engines[i].name, {{runs[i].wall_ms, runs[i].error_px}}});
      }
      double slowest = 0;
      for (const std::string setting :
           {"--method adam --rate 0.02 --decay --iterations 300", "--method adam --rate 0.05 --decay --iterations 300",
            "--method lbfgs --rate 1 --iterations 60"}) {
        const std::string call = Concatenate("/usr/bin/python3 ", script, " ", problem_path, " ", answer_path, " ",
                                             setting, " --threads ", threads_);
        if (std::system(call.c_str()) != 0) {
          report_.notes.push_back("pytorch: failed: " + call);
          continue;
        }
        PlotLine line{setting.find("lbfgs") != std::string::npos ? "L-BFGS" : "Adam " + setting.substr(21, 4), {}};
        for (const PeerMoment& moment : ReadPeerFile(*work, answer_path)) {
          SequenceProblem judged = moment.answer;
          SolveOptions judge;
          judge.max_iterations = 1;
          const double cost = SolveSequence(&judged, judge).initial_cost;
          bodyloom::Run run;
          run.wall_ms = 1e3 * moment.seconds / frames;
          run.cost = cost;
          run.iterations = moment.iterations;
          run.error_px = ProjectionErrorPx(*work, moment.answer.states, moment.answer.betas);
          line.points.emplace_back(run.wall_ms, run.error_px);
          slowest = std::max(slowest, run.wall_ms);
          report_.rows.push_back({"peers, " + text + " frames",
                                  {Concatenate("after ", moment.iterations), "PyTorch " + line.name},
                                  {run.wall_ms, kNaN, double(moment.iterations), run.error_px, bound,
                                   cost / std::min(runs[0].cost, runs[1].cost), kNaN}});
        }
        plot.lines.push_back(line);
      }
      plot.lines.push_back(
          {"Cramér–Rao", {{runs[1].wall_ms, bound}, {std::max(slowest, runs[0].wall_ms), bound}}, true});
      Save(plot, "work_precision_peers_" + text);
    }
  }

  const BenchArguments& arguments_;
  BenchReport report_;
  int threads_ = 1, repeat_ = 1;
};

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  const std::string data = BODYLOOM_SOURCE_DIR "/../shared/data/aistpp/motions/";
  return bodyloom::BenchMain(
      "bodyloom_bench_work_precision", argc, argv,
      {{"motions", data + "gBR_sBM_cAll_d06_mBR2_ch06.pkl," + data + "gJS_sBM_cAll_d03_mJS2_ch07.pkl"},
       {"sections", "set,tolerance,counts,lengths,threads,pytorch"},
       {"threads", "2"},
       {"repeat", "3"},
       {"lengths", "1,10,100,600"},
       {"pytorch_frames", "1,20"},
       {"plots", ""},
       {"json", ""}},
      [](const bodyloom::BenchArguments& arguments, const std::string& command) {
        bodyloom::Bench(arguments, command).Run();
      });
}
