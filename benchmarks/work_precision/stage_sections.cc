// SPDX-License-Identifier: Apache-2.0
/// Error against time of what users call: track, describe, evaluate, and the three after one another. One clip: real
/// motion, dense keypoints of 1 px noise, nothing else known but the camera.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "benchmarks/accuracy/dense_clips.h"
#include "benchmarks/work_precision/measure.h"
#include "benchmarks/work_precision/sections.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/descriptors/describe_track.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "geometry/base/check.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct StageClip {
  SynthClip clip;
  double bound_px = kNaN;
};

StageClip MakeStageClip(const WorkBench& bench, int frames, int dense) {
  SynthClipOptions synth;
  synth.dense_per_frame = dense;
  synth.dense = DenseFaults("pixel");
  synth.num_threads = bench.threads;
  StageClip made;
  made.clip = MakeSynthClip(BuiltinBody(), FirstFrames(LoadMotion(bench.arguments.List("motions")[0]), frames), synth);
  DenseBoundOptions bound;
  bound.smooth = frames > 2;
  made.bound_px = DenseBound(BuiltinBody(), made.clip, bound).mean_px;
  return made;
}

TrackSequenceResult TrackOf(const SynthClip& clip, const TrackSequenceOptions& options) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.keypoints = &clip.keypoints;
  input.dense = &clip.dense;
  input.camera = clip.truth.camera;
  return FitClip(input, options);
}

double TrackErrorPx(const Track& track, const SynthClip& clip, int threads) {
  VertexErrorOptions options;
  options.num_threads = threads;
  options.vertex_step = 10;
  return EvaluateAgainstTruth(track, clip.truth, BuiltinBody(), options).Value("projection_mean_px");
}

/// The values of a row in the order of kWorkColumns.
std::vector<double> Row(const Timing& timing, double iterations, double error, double bound, double peak_mb) {
  return {timing.wall.median,
          timing.wall.spread_percent,
          timing.cpu.median,
          timing.cpu.spread_percent,
          iterations,
          error,
          bound,
          kNaN,
          peak_mb};
}

/// One row, and the point of a plot.
void MeasureTrack(WorkBench* bench, const std::string& group, const std::string& label, const StageClip& made,
                  const TrackSequenceOptions& options, PlotLine* line) {
  TrackSequenceResult result;
  ResetPeak();
  const double before = PeakMegabytes();
  const Timing timing =
      MeasureAction([&] { result = TrackOf(made.clip, options); }, bench->repeat, made.clip.truth.num_frames());
  const double peak = PeakMegabytes() - before;
  const double error = TrackErrorPx(result.track, made.clip, bench->threads);
  bench->AddRow(group, label, ToString(options.solver),
                Row(timing, result.summary.iterations, error, made.bound_px, peak));
  if (line != nullptr) line->points.emplace_back(timing.cpu.median, error);
}

struct DescribeSetting {
  std::string name;
  DescribeTrackOptions options;
};

DescribeTrackOptions MapOptions(const WorkBench& bench, int size) {
  DescribeTrackOptions options;
  options.texels.width = options.texels.height = size;
  options.past = 1;
  options.num_threads = bench.threads;
  return options;
}

}  // namespace

void TrackSection(WorkBench* bench) {
  Plot plot{"work_precision_track",
            "track: 100 frames, 300 keypoints",
            "processor time, ms a frame",
            "mean error, px at 512",
            true,
            true,
            {}};
  const StageClip made = MakeStageClip(*bench, 100, 300);
  TrackSequenceOptions options;
  options.num_threads = bench->threads;
  for (const std::string solver : {"ceres", "chain"}) {
    options.solver = SequenceSolverFromString(solver);
    PlotLine line{solver, {}};
    for (int iterations : {1, 2, 4, 8, 16}) {
      options.max_fine_iterations = iterations;
      MeasureTrack(bench, "track, fine iterations", std::to_string(iterations), made, options, &line);
    }
    plot.lines.push_back(line);
  }
  options = {};
  options.num_threads = bench->threads;
  PlotLine rates{"chain, coarse rate", {}};
  for (double rate : {4.0, 8.0, 15.0, 30.0}) {
    options.coarse_rate = rate;
    MeasureTrack(bench, "track, coarse frames a second", Concatenate(rate), made, options, &rates);
  }
  options.coarse_rate = TrackSequenceOptions{}.coarse_rate;
  plot.lines.push_back(rates);
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const PlotLine& line : plot.lines) {
    for (const auto& [x, y] : line.points) low = std::min(low, x), high = std::max(high, x);
  }
  plot.lines.push_back({"Cramér–Rao", {{low, made.bound_px}, {high, made.bound_px}}, true});
  bench->report.plots.push_back(plot);

  for (int threads : {1, 2}) {
    options.num_threads = threads;
    MeasureTrack(bench, "track, threads", std::to_string(threads), made, options, nullptr);
  }
  options.num_threads = bench->threads;
  for (int dense : {20, 100, 300, 1000, 5000}) {
    MeasureTrack(bench, "track, keypoints a frame", std::to_string(dense), MakeStageClip(*bench, 50, dense), options,
                 nullptr);
  }
  for (int frames : {1, 10, 100, 600}) {
    MeasureTrack(bench, "track, frames", std::to_string(frames), MakeStageClip(*bench, frames, 300), options, nullptr);
  }
}

void DescribeSection(WorkBench* bench) {
  constexpr int kFrames = 24;
  const StageClip made = MakeStageClip(*bench, kFrames, 300);
  TrackSequenceOptions track_options;
  track_options.num_threads = bench->threads;
  const Track tracked = TrackOf(made.clip, track_options).track;
  const MapTruth truth(BuiltinBody(), made.clip.truth);
  const TemporaryFolder folder;
  const std::string path = folder.File("maps.npy");
  Plot speed{"work_precision_describe",
             "describe: maps of 32² to 512² texels",
             "processor time, ms a frame",
             "error of velocities, mm/s (rms)",
             true,
             true,
             {}};
  const auto measure = [&](const std::string& group, const std::string& label, const std::string& subject,
                           const Track& track, const DescribeTrackOptions& options, PlotLine* line) {
    ResetPeak();
    const double before = PeakMegabytes();
    const Timing timing =
        MeasureAction([&] { DescribeTrack(BuiltinBody(), track, path, options); }, bench->repeat, kFrames);
    const double peak = PeakMegabytes() - before;
    const MapError error = truth.ErrorOf(path, options.texels.width);
    bench->AddRow(group + ": velocity, mm/s", label, subject, Row(timing, kNaN, error.velocity_mm_s, kNaN, peak));
    bench->AddRow(group + ": normal, degrees", label, subject, Row(timing, kNaN, error.normal_deg, kNaN, kNaN));
    if (line != nullptr) line->points.emplace_back(timing.cpu.median, error.velocity_mm_s);
  };
  for (const auto& [subject, track] :
       {std::pair<std::string, const Track*>{"the true poses", &made.clip.truth}, {"the tracked poses", &tracked}}) {
    PlotLine line{subject, {}};
    for (int size : {32, 64, 128, 256, 512}) {
      DescribeTrackOptions options = MapOptions(*bench, size);
      options.analytic = true;
      options.velocity.scheme = VelocityScheme::kCentral;
      measure("describe, texels a side", std::to_string(size), subject, *track, options, &line);
    }
    speed.lines.push_back(line);
    for (const auto& [name, scheme] : {std::pair<std::string, VelocityScheme>{"backward", VelocityScheme::kBackward},
                                       {"central", VelocityScheme::kCentral},
                                       {"Savitzky–Golay", VelocityScheme::kSavitzkyGolay}}) {
      for (bool analytic : {false, true}) {
        DescribeTrackOptions options = MapOptions(*bench, 128);
        options.analytic = analytic;
        options.velocity.scheme = scheme;
        measure("describe, velocities", name + (analytic ? ", analytic" : ", differences"), subject, *track, options,
                nullptr);
      }
    }
  }
  for (int threads : {1, 2}) {
    DescribeTrackOptions options = MapOptions(*bench, 128);
    options.num_threads = threads;
    measure("describe, threads", std::to_string(threads), "the true poses", made.clip.truth, options, nullptr);
  }
  bench->report.plots.push_back(speed);
}

void EvaluateSection(WorkBench* bench) {
  constexpr int kFrames = 100;
  const StageClip made = MakeStageClip(*bench, kFrames, 300);
  TrackSequenceOptions track_options;
  track_options.num_threads = bench->threads;
  const Track tracked = TrackOf(made.clip, track_options).track;
  Plot plot{"work_precision_evaluate",
            "evaluate: every n-th vertex, 1 to 300",
            "processor time, ms a frame",
            "change of the mean projection error, %",
            true,
            true,
            {{"every n-th vertex", {}}}};
  double all = 0;
  for (int step : {1, 3, 10, 30, 100, 300}) {
    VertexErrorOptions options;
    options.num_threads = bench->threads;
    options.vertex_step = step;
    double value = 0;
    ResetPeak();
    const double before = PeakMegabytes();
    const Timing timing = MeasureAction(
        [&] {
          value = EvaluateAgainstTruth(tracked, made.clip.truth, BuiltinBody(), options).Value("projection_mean_px");
        },
        bench->repeat, kFrames);
    if (step == 1) all = value;
    const double change = 100 * std::abs(value / all - 1);
    bench->AddRow("evaluate, every n-th vertex: change, %", std::to_string(step), "known-truth",
                  Row(timing, kNaN, change, kNaN, PeakMegabytes() - before));
    plot.lines[0].points.emplace_back(timing.cpu.median, change);
  }
  bench->report.plots.push_back(plot);
}

void WholeSection(WorkBench* bench) {
  const TemporaryFolder folder;
  const std::string path = folder.File("whole.npy");
  for (int frames : {1, 10, 100, 600}) {
    const StageClip made = MakeStageClip(*bench, frames, 300);
    TrackSequenceOptions track_options;
    track_options.num_threads = bench->threads;
    DescribeTrackOptions describe = MapOptions(*bench, 128);
    describe.past = 10;
    VertexErrorOptions evaluate;
    evaluate.num_threads = bench->threads;
    evaluate.vertex_step = 10;
    Track track;
    double error = kNaN;
    ResetPeak();
    const double before = PeakMegabytes();
    const Timing tracking =
        MeasureAction([&] { track = TrackOf(made.clip, track_options).track; }, bench->repeat, frames);
    const Timing describing =
        MeasureAction([&] { DescribeTrack(BuiltinBody(), track, path, describe); }, bench->repeat, frames);
    const Timing evaluating = MeasureAction(
        [&] {
          error = EvaluateAgainstTruth(track, made.clip.truth, BuiltinBody(), evaluate).Value("projection_mean_px");
        },
        bench->repeat, frames);
    const double peak = PeakMegabytes() - before;
    Timing together;
    together.wall.median = tracking.wall.median + describing.wall.median + evaluating.wall.median;
    together.cpu.median = tracking.cpu.median + describing.cpu.median + evaluating.cpu.median;
    const std::string label = std::to_string(frames) + (frames == 1 ? " frame" : " frames");
    bench->AddRow("whole", label, "track", Row(tracking, kNaN, error, made.bound_px, kNaN));
    bench->AddRow("whole", label, "describe (33 × 128²)", Row(describing, kNaN, kNaN, kNaN, kNaN));
    bench->AddRow("whole", label, "evaluate", Row(evaluating, kNaN, kNaN, kNaN, kNaN));
    bench->AddRow("whole", label, "together", Row(together, kNaN, error, made.bound_px, peak));
  }
}

}  // namespace bodyloom
