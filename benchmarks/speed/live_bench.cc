// SPDX-License-Identifier: Apache-2.0
/// The live tracker against the solve of the whole clip: error on the same data, frame rate, latency, memory.
///
///   bodyloom_bench_live [--sections real,synthetic,lags,long,skip,uncertainty] [--uncertainty no] [--threads 2]
///                       [--frames 0] [--views c01,c05] [--lags 0,2,4,8,16] [--long 20000] [--repeat 1] [--json F]
///
/// real: AIST++, 17 detected joints, scored in the other eight cameras (protocol aist-held-out). synthetic: the same
/// motions as 300 dense keypoints of 1 px noise, and as joints alone, with known truth (protocol known-truth).
/// fps: frames over wall time of all Push() calls; cpu_ms: processor time a frame; push_…: one Push(), wall time.
/// uncertainty: whether the poses come with joint_sigma (the section of that name compares both).
/// mb_grown: resident memory after the clip over that after its first tenth.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <limits>
#include <memory>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/work_precision/work_problem.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/stopwatch.h"
#include "tests/support/paths.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/live/track_live.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double ResidentMegabytes() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
  }
  return kNaN;
}

/// fps, cpu_ms, push_median_ms, push_p99_ms, push_max_ms, mb_grown of `frames` frames; past the end of the clip it
/// runs backwards, and forwards again.
std::vector<double> Speed(const TrackSequenceInput& input, const LiveTrackerOptions& options, int frames, int repeat) {
  const std::vector<double>& times = input.keypoints != nullptr ? input.keypoints->timestamps : input.dense->timestamps;
  const int T = static_cast<int>(times.size()), period = std::max(1, 2 * T - 2);
  const double step = T > 1 ? (times[T - 1] - times[0]) / (T - 1) : 1.0 / 30;
  std::vector<std::vector<double>> runs;
  for (int run = 0; run < repeat; ++run) {
    LiveTracker tracker(LiveInputFor(input), options);
    std::vector<double> push_ms;
    double early_mb = kNaN;
    const std::clock_t cpu = std::clock();
    for (int t = 0; t < frames; ++t) {
      const int k = t % period;
      LiveObservations seen = ObservationsAt(input, k < T ? k : period - k);
      seen.timestamp = t * step;
      const Stopwatch watch;
      tracker.Push(seen);
      push_ms.push_back(1e3 * watch.seconds());
      if (t == frames / 10) early_mb = ResidentMegabytes();
    }
    double total = 0;
    for (double ms : push_ms) total += ms;
    runs.push_back({1e3 * frames / total, 1e3 * double(std::clock() - cpu) / CLOCKS_PER_SEC / frames,
                    Percentile(push_ms, 50), Percentile(push_ms, 99), Percentile(push_ms, 100),
                    ResidentMegabytes() - early_mb});
  }
  std::sort(runs.begin(), runs.end());
  return runs[runs.size() / 2];
}

class Bench {
 public:
  Bench(const BenchArguments& arguments, std::string command) : arguments_(arguments) {
    report_.title = "Live tracking beside the solve of the whole clip";
    report_.command = std::move(command);
    report_.label_columns = {"clip", "tracker"};
    report_.value_columns = {"error",  "over_batch",     "pa_mpjpe_mm", "accel_err_ms2", "fps",
                             "cpu_ms", "push_median_ms", "push_p99_ms", "push_max_ms",   "mb_grown"};
    report_.summarise = false;
    report_.notes = {"error: real: median px in the other eight cameras; synthetic: mean projection, px at 512",
                     Concatenate("threads: ", arguments.Integer("threads"))};
    options_.solve.num_threads = arguments.Integer("threads");
    options_.solve.estimate_uncertainty = arguments.Text("uncertainty") == "yes";
    options_.lag = arguments.Integer("lag");
    options_.context = arguments.Integer("context");
    options_.iterations = arguments.Integer("iterations");
    options_.reuse_linearisation = std::stod(arguments.Text("skip"));
    options_.solve.lifter_weight = std::stod(arguments.Text("lifter_weight"));
  }

  void Run() {
    for (const std::string& section : arguments_.List("sections")) {
      if (section == "real")
        Real();
      else if (section == "synthetic")
        Synthetic();
      else if (section == "lags")
        Lags();
      else if (section == "long")
        Long();
      else if (section == "skip")
        Skip();
      else if (section == "uncertainty")
        Uncertainty();
      else
        BODYLOOM_CHECK(false, "--sections names '", section, "'");
    }
    HandOver(report_, arguments_.Text("json"));
  }

 private:
  struct Clip {
    std::string name;
    MultiViewClip truth;
    std::string view;
    KeypointSequence keypoints;
    TrackSequenceInput input;
  };

  std::vector<std::unique_ptr<Clip>> RealClips() const {
    std::vector<std::unique_ptr<Clip>> clips;
    const std::string data = arguments_.Text("data");
    for (const std::string& sequence : arguments_.List("sequences")) {
      const MultiViewClip truth = ReadAistClip(data, data + "/cameras", sequence);
      for (const std::string& view : arguments_.List("views")) {
        auto clip = std::make_unique<Clip>();
        clip->name = sequence.substr(0, 3) + " " + view;
        clip->truth = truth;
        clip->view = view;
        const NamedCamera camera = FindCamera(LoadCameras(data + "/cameras", sequence), view, data);
        LoadDetectionsOptions load;
        load.view = view;
        load.image_width = camera.camera.width;
        load.image_height = camera.camera.height;
        clip->keypoints = LoadDetections(data + "/keypoints2d/" + sequence + ".pkl", load);
        Fill(&clip->input);
        clip->input.keypoints = &clip->keypoints;
        clip->input.camera = camera.camera;
        clips.push_back(std::move(clip));
      }
    }
    return clips;
  }

  static void Fill(TrackSequenceInput* input) {
    input->body = &BuiltinBody();
    input->prior = &BuiltinPosePrior();
    input->lifter = &BuiltinLifter();
  }

  void Add(const std::string& group, const std::string& name, const std::string& tracker, double error, double batch,
           const Evaluation& evaluation, std::vector<double> speed) {
    BenchRow row;
    row.group = group;
    row.labels = {name, tracker};
    row.values = {error, error / batch, evaluation.Value("pa_mpjpe_mm"), evaluation.Value("accel_err_ms2")};
    speed.resize(6, kNaN);
    row.values.insert(row.values.end(), speed.begin(), speed.end());
    std::fprintf(stderr, "%s, %s, %s: error %.3f (%.3f of batch), PA %.1f mm, %.0f fps, cpu %.2f ms\n", group.c_str(),
                 name.c_str(), tracker.c_str(), error, error / batch, row.values[2], speed[0], speed[1]);
    report_.rows.push_back(std::move(row));
  }

  /// Live and batch on one clip; `score` gives the error and the rest.
  template <typename Score>
  void Compare(const std::string& group, const std::string& name, const TrackSequenceInput& input, const Score& score) {
    const int T = input.keypoints != nullptr ? input.keypoints->num_frames() : input.dense->num_frames();
    const Stopwatch watch;
    const std::clock_t cpu = std::clock();
    const TrackSequenceResult batch = FitClip(input, options_.solve);
    const double fps = T / watch.seconds(), cpu_ms = 1e3 * double(std::clock() - cpu) / CLOCKS_PER_SEC / T;
    Evaluation evaluation;
    const double error = score(batch.track, &evaluation);
    Add(group, name, "batch", error, error, evaluation, {fps, cpu_ms, kNaN, kNaN, kNaN, kNaN});
    const TrackSequenceResult live = TrackLive(input, options_);
    const double live_error = score(live.track, &evaluation);
    Add(group, name, Concatenate("live, lag ", options_.lag), live_error, error, evaluation,
        Speed(input, options_, T, arguments_.Integer("repeat")));
  }

  void Real() {
    for (const auto& clip : RealClips()) {
      Compare("real, 17 joints", clip->name, clip->input, [&](const Track& track, Evaluation* evaluation) {
        *evaluation = EvaluateAist(track, clip->truth, clip->view);
        return evaluation->Value("heldout_median_px");
      });
    }
  }

  [[nodiscard]] SynthClip MakeClip(const std::string& motion, bool dense) const {
    SynthClipOptions synth;
    synth.dense_per_frame = dense ? arguments_.Integer("dense") : 0;
    synth.dense = DenseFaults("pixel");
    synth.keypoints = true;
    return MakeSynthClip(BuiltinBody(), FirstFrames(LoadMotion(motion), arguments_.Integer("frames")), synth);
  }

  [[nodiscard]] static TrackSequenceInput InputOf(const SynthClip& clip, bool dense) {
    TrackSequenceInput input;
    Fill(&input);
    input.keypoints = &clip.keypoints;
    if (dense) input.dense = &clip.dense;
    input.camera = clip.truth.camera;
    return input;
  }

  void Synthetic() {
    for (const std::string& motion : arguments_.List("motions")) {
      for (const bool dense : {true, false}) {
        const SynthClip clip = MakeClip(motion, dense);
        const TrackSequenceInput input = InputOf(clip, dense);
        const std::string group = dense
                                      ? Concatenate("synthetic, ", arguments_.Integer("dense"), " keypoints and joints")
                                      : Concatenate("synthetic, ", clip.keypoints.num_points(), " joints");
        Compare(group, MotionName(motion), input, [&](const Track& track, Evaluation* evaluation) {
          *evaluation = EvaluateAgainstTruth(track, clip.truth, BuiltinBody(), {});
          return evaluation->Value("projection_mean_px");
        });
      }
    }
  }

  void Lags() {
    for (const auto& clip : RealClips()) {
      const TrackSequenceResult batch = FitClip(clip->input, options_.solve);
      const double error = EvaluateAist(batch.track, clip->truth, clip->view).Value("heldout_median_px");
      for (const std::string& lag : arguments_.List("lags")) {
        LiveTrackerOptions options = options_;
        options.lag = std::stoi(lag);
        const TrackSequenceResult live = TrackLive(clip->input, options);
        const Evaluation evaluation = EvaluateAist(live.track, clip->truth, clip->view);
        Add("lag", clip->name, Concatenate("live, lag ", lag), evaluation.Value("heldout_median_px"), error, evaluation,
            Speed(clip->input, options, clip->keypoints.num_frames(), 1));
      }
    }
  }

  void Long() {
    const SynthClip clip = MakeClip(arguments_.List("motions")[0], true);
    const int frames = arguments_.Integer("long");
    for (const bool dense : {false, true}) {
      const TrackSequenceInput input = InputOf(clip, dense);
      std::vector<double> speed = Speed(input, options_, frames, 1);
      BenchRow row{
          "long", {Concatenate(frames, " frames"), dense ? "live, dense" : "live, joints"}, {kNaN, kNaN, kNaN, kNaN}};
      row.values.insert(row.values.end(), speed.begin(), speed.end());
      report_.rows.push_back(row);
    }
  }

  /// Cost of joint_sigma: with it, without it and with it again, to detect drift of the machine.
  void Uncertainty() {
    const std::string motion = arguments_.List("motions")[0];
    for (const bool dense : {false, true}) {
      const SynthClip clip = MakeClip(motion, dense);
      const TrackSequenceInput input = InputOf(clip, dense);
      for (const bool on : {true, false, true}) {
        LiveTrackerOptions options = options_;
        options.solve.estimate_uncertainty = on;
        std::vector<double> speed = Speed(input, options, clip.keypoints.num_frames(), arguments_.Integer("repeat"));
        BenchRow row{"uncertainty",
                     {dense ? Concatenate(arguments_.Integer("dense"), " keypoints and joints") : std::string("joints"),
                      on ? "with joint_sigma" : "without"},
                     {kNaN, kNaN, kNaN, kNaN}};
        row.values.insert(row.values.end(), speed.begin(), speed.end());
        report_.rows.push_back(row);
      }
    }
  }

  /// The solve of a whole clip with and without ChainOptions::reuse_linearisation: error is the cost over the lowest.
  void Skip() {
    for (const std::string& frames : arguments_.List("skip_frames")) {
      WorkProblemOptions problem_options;
      problem_options.motion = arguments_.List("motions")[0];
      problem_options.frames = std::stoi(frames);
      problem_options.dense = arguments_.Integer("dense");
      const auto work = MakeWorkProblem(problem_options);
      std::vector<BenchRow> rows;
      double lowest = std::numeric_limits<double>::infinity();
      for (const double share : {0.0, 0.01, 0.03, 0.1}) {
        std::vector<std::pair<double, double>> times;
        SolveReport report;
        for (int round = 0; round < arguments_.Integer("repeat"); ++round) {
          SequenceProblem problem = work->problem;
          SolveOptions options;
          options.solver = SequenceSolver::kChain;
          options.num_threads = arguments_.Integer("threads");
          options.chain.reuse_linearisation = share;
          const std::clock_t cpu = std::clock();
          report = SolveSequence(&problem, options);
          times.emplace_back(1e3 * double(std::clock() - cpu) / CLOCKS_PER_SEC / problem_options.frames,
                             1e3 * report.seconds / problem_options.frames);
        }
        std::sort(times.begin(), times.end());
        const auto [cpu_ms, wall_ms] = times[times.size() / 2];
        lowest = std::min(lowest, report.final_cost);
        rows.push_back(
            {"solve of " + frames + " frames, reuse_linearisation",
             {Concatenate(share),
              Concatenate(report.iterations, " iterations, skipped ",
                          100 * report.frames_skipped / (report.frames_skipped + report.frames_evaluated), " %")},
             {report.final_cost, kNaN, kNaN, kNaN, 1e3 / wall_ms, cpu_ms, kNaN, kNaN, kNaN, kNaN}});
      }
      for (BenchRow& row : rows) {
        row.values[1] = row.values[0] / lowest;
        report_.rows.push_back(row);
      }
    }
    report_.notes.push_back("skip: error is the final cost, over_batch the same over the lowest of the group");
  }

  const BenchArguments& arguments_;
  BenchReport report_;
  LiveTrackerOptions options_;
};

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  const std::string data = bodyloom::SharedDir() + "/data/aistpp";
  const std::string motions = data + "/motions/";
  return bodyloom::BenchMain(
      "bodyloom_bench_live", argc, argv,
      {{"data", data},
       {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
       {"views", "c01,c03,c05,c07,c08"},
       {"motions", motions + "gBR_sBM_cAll_d06_mBR2_ch06.pkl," + motions + "gJS_sBM_cAll_d03_mJS2_ch07.pkl"},
       {"sections", "real,synthetic,lags,long,skip,uncertainty"},
       {"uncertainty", "no"},
       {"frames", "0"},
       {"dense", "300"},
       {"threads", "2"},
       {"lag", "4"},
       {"context", "4"},
       {"iterations", "2"},
       {"skip", "0.1"},
       {"lifter_weight", "0.06"},
       {"skip_frames", "100,600"},
       {"lags", "0,2,4,8,16"},
       {"long", "20000"},
       {"repeat", "1"},
       {"json", ""}},
      [](const bodyloom::BenchArguments& arguments, const std::string& command) {
        bodyloom::Bench(arguments, command).Run();
      });
}
