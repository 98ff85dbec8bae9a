// SPDX-License-Identifier: Apache-2.0
/// Tracks synthetic clips of real motion from dense surface keypoints and compares with the known truth and with the
/// Cramér–Rao bound of the keypoints' noise.
///
///   bodyloom_bench_dense --motions A.pkl,B.bvh [--noise pixel,densepose] [--dense 300] [--initial 14.8] [--frames 0]
///                        [--threads 2] [--json F]
///
/// noise `pixel`: 1 px Gaussian. `densepose`: 1 px, UV noise 0.02 of a chart, 8-bit UV, 5 % outliers, each part missing
/// 5 % of the time. Projection errors are pixels of the image scaled to 512 by its longer side (paper A, Table 4: 10.5
/// ± 2.1 from real DensePose, its initialiser 14.8).
#include <cstdio>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "tests/support/paths.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

BenchRow TrackAndScore(const std::string& noise, const std::string& name, const Motion& motion,
                       const BenchArguments& arguments) {
  const BodyModel& body = BuiltinBody();
  SynthClipOptions synth;
  synth.dense_per_frame = arguments.Integer("dense");
  synth.dense = DenseFaults(noise);
  synth.keypoints = false;
  synth.initialiser_error_px = std::stod(arguments.Text("initial"));
  synth.num_threads = arguments.Integer("threads");
  const SynthClip clip = MakeSynthClip(body, motion, synth);

  TrackSequenceInput input;
  input.body = &body;
  input.prior = &BuiltinPosePrior();
  input.dense = &clip.dense;
  input.initialiser = &clip.initialiser;
  input.camera = clip.truth.camera;
  TrackSequenceOptions options;
  options.num_threads = arguments.Integer("threads");
  const Stopwatch watch;
  const TrackSequenceResult result = FitClip(input, options);
  const double seconds = watch.seconds();

  VertexErrorOptions evaluate;
  evaluate.num_threads = arguments.Integer("threads");
  const Evaluation evaluation = EvaluateAgainstTruth(result.track, clip.truth, body, evaluate);
  DenseBoundOptions smooth;
  smooth.smooth = true;
  const ProjectionBound bound = DenseBound(body, clip), smooth_bound = DenseBound(body, clip, smooth);
  const double mean_px = evaluation.Value("projection_mean_px");
  return {"noise: " + noise,
          {name},
          {clip.initialiser_error_px, mean_px, evaluation.Value("projection_std_px"),
           evaluation.Value("projection_p95_px"), bound.mean_px, smooth_bound.mean_px, mean_px / smooth_bound.mean_px,
           evaluation.Value("pve_mm"), evaluation.Value("pa_mpjpe_mm"), evaluation.Value("joint_angle_err_deg"),
           evaluation.Value("accel_err_ms2"), double(evaluation.frames_without_result),
           double(result.summary.iterations), 1e3 * seconds / motion.num_frames()}};
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "Dense keypoints of synthetic clips with known truth";
  report.command = command;
  report.label_columns = {"motion"};
  report.value_columns = {"initial_px",     "mean_px",       "std_px",          "p95_px",
                          "frame_bound_px", "clip_bound_px", "mean/clip_bound", "pve_mm",
                          "pa_mpjpe_mm",    "angle_err_deg", "accel_err_ms2",   "frames_without_result",
                          "iterations",     "ms_per_frame"};
  report.notes = {
      "accuracy: protocol known-truth (docs/evaluation.md), pixels at 512",
      "bounds: Cramer-Rao, of independent frames, and with accelerations of this motion's size",
      Concatenate("threads: ", arguments.Integer("threads"), ", keypoints a frame: ", arguments.Integer("dense"))};
  for (const std::string& noise : arguments.List("noise")) {
    for (const std::string& path : arguments.List("motions")) {
      const Motion motion = FirstFrames(LoadMotion(path), arguments.Integer("frames"));
      const std::string name = MotionName(path);
      report.rows.push_back(TrackAndScore(noise, name, motion, arguments));
      std::fprintf(stderr, "%s %s: %.1f -> %.2f px, bound %.2f\n", noise.c_str(), name.c_str(),
                   report.rows.back().values[0], report.rows.back().values[1], report.rows.back().values[5]);
    }
  }
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  const std::string data = bodyloom::SharedDir() + "/data/aistpp/motions/";
  return bodyloom::BenchMain(
      "bodyloom_bench_dense", argc, argv,
      {{"motions", data + "gBR_sBM_cAll_d06_mBR2_ch06.pkl," + data + "gJS_sBM_cAll_d03_mJS2_ch07.pkl"},
       {"noise", "pixel,densepose"},
       {"dense", "300"},
       {"initial", "14.8"},
       {"frames", "0"},
       {"threads", "2"},
       {"json", ""}},
      bodyloom::Run);
}
