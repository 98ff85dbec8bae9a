// SPDX-License-Identifier: Apache-2.0
/// Benefit and cost of the rendered-UV term (L_r) and of the part-label terms.
///
///   bodyloom_bench_rendered_uv [--what dense,basin,labels] [--motions A.pkl,B.bvh] [--noise pixel,uv,densepose]
///                              [--residuals "reprojection,whitened,rendered UV"] [--dense 300] [--initial 14.8]
///                              [--frames 0] [--rounds 1] [--fine_iterations 8] [--min_cosine 0.5]
///                              [--starts 15,30,45,60] [--trials 60] [--block 1,6] [--threads 2] [--json F]
///
/// dense   whole clips tracked from dense keypoints and an initialiser: reprojection with one σ a keypoint;
///         reprojection whitened by the UV covariance; rendered UV after it.
/// basin   single frames from starts of stated error, the shape known, densepose noise: success is a final per-vertex
///         projection error below 4 px at 512 px. Reprojection only, rendered UV only (unmatched pixels saturate), the
///         two in turn.
/// labels  clips tracked from part labels alone (of the truth, by blocks of so many pixels) from an initialiser.
/// Errors: protocol known-truth (docs/evaluation.md), pixels at 512.
#include <cstdio>
#include <functional>
#include <numeric>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/dense_clips.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/truth_evaluation.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "render/raster/visibility_buffer.h"
#include "tests/support/paths.h"
#include "tests/support/rendered_labels.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/initialise/lifted_landmarks.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/problem/clip_term.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/pose_prior/pose_prior.h"
#include "tracking/terms/rendered_uv/rendered_uv.h"

namespace bodyloom {
namespace {

SynthClip MakeClip(const std::string& noise, const Motion& motion, double initial_px, uint64_t seed,
                   const BenchArguments& arguments) {
  SynthClipOptions synth;
  synth.seed = seed;
  synth.dense_per_frame = arguments.Integer("dense");
  synth.dense = DenseFaults(noise);
  synth.keypoints = false;
  synth.initialiser_error_px = initial_px;
  synth.num_threads = arguments.Integer("threads");
  return MakeSynthClip(BuiltinBody(), motion, synth);
}

TrackSequenceInput InputOf(const SynthClip& clip) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.dense = &clip.dense;
  input.initialiser = &clip.initialiser;
  input.camera = clip.truth.camera;
  return input;
}

/// Tracks and scores: the value columns of whole clips.
std::vector<double> TrackAndScore(const TrackSequenceInput& input, const TrackSequenceOptions& options,
                                  const SynthClip& clip) {
  const Stopwatch watch;
  const TrackSequenceResult result = FitClip(input, options);
  const double seconds = watch.seconds();
  BODYLOOM_CHECK(result.summary.IsUsable(), "not tracked: ", result.summary.message);
  VertexErrorOptions evaluate;
  evaluate.num_threads = options.num_threads;
  const Evaluation e = EvaluateAgainstTruth(result.track, clip.truth, *input.body, evaluate);
  std::fprintf(stderr, "%s\nevaluation %.2f s, linear solver %.2f s", result.summary.BriefReport().c_str(),
               result.summary.seconds_evaluation, result.summary.seconds_linear_solver);
  for (const auto& [stage, s] : result.summary.seconds) std::fprintf(stderr, ", %s %.2f s", stage.c_str(), s);
  std::fprintf(stderr, "\n");
  return {clip.initialiser_error_px,
          e.Value("projection_mean_px"),
          e.Value("projection_std_px"),
          e.Value("projection_p95_px"),
          e.Value("pve_mm"),
          e.Value("pa_mpjpe_mm"),
          e.Value("joint_angle_err_deg"),
          e.Value("accel_err_ms2"),
          double(result.summary.iterations),
          1e3 * seconds / result.track.num_frames()};
}

const std::vector<std::string> kClipColumns = {"initial_px", "mean_px",     "std_px",        "p95_px",
                                               "pve_mm",     "pa_mpjpe_mm", "angle_err_deg", "accel_err_ms2",
                                               "iterations", "ms_per_frame"};

void DenseClips(const BenchArguments& arguments, BenchReport* report) {
  report->label_columns = {"motion", "residual"};
  report->value_columns = kClipColumns;
  for (const std::string& noise : arguments.List("noise")) {
    for (const std::string& path : arguments.List("motions")) {
      const Motion motion = FirstFrames(LoadMotion(path), arguments.Integer("frames"));
      SynthClip clip = MakeClip(noise, motion, std::stod(arguments.Text("initial")), 1, arguments);
      const double uv_sigma = clip.dense.uv_sigma;
      for (const std::string& residual : arguments.List("residuals")) {
        TrackSequenceOptions options;
        options.num_threads = arguments.Integer("threads");
        options.max_fine_iterations = arguments.Integer("fine_iterations");
        options.rendered_uv.rounds = arguments.Integer("rounds");
        options.rendered_uv.min_cosine = std::stod(arguments.Text("min_cosine"));
        options.rendered_uv.weight = residual == "rendered UV" ? 1 : 0;
        options.rendered_uv.only_with_uv_noise = false;
        clip.dense.uv_sigma = residual == "reprojection" ? 0 : uv_sigma;
        report->rows.push_back(
            {"noise: " + noise, {MotionName(path), residual}, TrackAndScore(InputOf(clip), options, clip)});
        std::fprintf(stderr, "%s %s %s: %.2f px\n", noise.c_str(), MotionName(path).c_str(), residual.c_str(),
                     report->rows.back().values[1]);
      }
    }
  }
}

void LabelClips(const BenchArguments& arguments, BenchReport* report) {
  report->label_columns = {"motion", "terms"};
  report->value_columns = kClipColumns;
  for (const std::string& block : arguments.List("block")) {
    for (const std::string& path : arguments.List("motions")) {
      const Motion motion = FirstFrames(LoadMotion(path), arguments.Integer("frames"));
      const SynthClip clip = MakeClip("pixel", motion, std::stod(arguments.Text("initial")), 1, arguments);
      const PartLabelSequence labels = RenderPartLabels(BuiltinBody(), clip.truth, std::stoi(block));
      for (const std::string terms : {"silhouette", "parts", "both"}) {
        TrackSequenceInput input = InputOf(clip);
        input.dense = nullptr;
        input.part_labels = &labels;
        TrackSequenceOptions options;
        options.num_threads = arguments.Integer("threads");
        if (terms == "silhouette") options.part_labels.part_weight = 0;
        if (terms == "parts") options.part_labels.silhouette_weight = 0;
        report->rows.push_back(
            {"labels in blocks of " + block + " px", {MotionName(path), terms}, TrackAndScore(input, options, clip)});
        std::fprintf(stderr, "block %s %s %s: %.2f px\n", block.c_str(), MotionName(path).c_str(), terms.c_str(),
                     report->rows.back().values[1]);
      }
    }
  }
}

double MeanProjectionErrorAt512(const SynthClip& clip, const FrameState& state) {
  const BodyModel& body = BuiltinBody();
  const Motion& truth = clip.truth.motion;
  const MatrixX3d a = PoseVertices(body, truth.betas, {state.rotations, state.translation});
  const MatrixX3d b = PoseVertices(
      body, truth.betas, PoseFromAxisAngle(body, truth.poses.row(0).transpose(), truth.trans.row(0).transpose()));
  double sum = 0;
  Eigen::Vector2d p, q;
  for (Eigen::Index v = 0; v < a.rows(); ++v) {
    const bool seen = clip.truth.camera.Project(a.row(v), &p) && clip.truth.camera.Project(b.row(v), &q);
    sum += seen ? (p - q).norm() : clip.truth.camera.width;
  }
  return sum / double(a.rows()) * 512 / std::max(clip.truth.camera.width, clip.truth.camera.height);
}

struct BasinResult {
  double error_px = 0, ms = 0;
  int iterations = 0;
};

/// One frame, shape and camera known, from the clip's initialiser.
BasinResult SolveFrame(const SynthClip& clip, const std::string& method, const std::vector<int>& joints) {
  const BodyModel& body = BuiltinBody();
  const TrackSequenceInput input = InputOf(clip);
  TrackSequenceOptions options;
  options.rendered_uv.weight = method == "reprojection" ? 0 : 1;
  options.rendered_uv.unmatched_reproject = method != "rendered UV";
  SequenceProblem problem;
  problem.layout = FrameLayout::Make(body, CameraKnowledge::kKnown, input.camera, joints, body.num_betas());
  problem.betas = Eigen::VectorXd::Zero(body.num_betas());
  problem.betas.head(clip.truth.motion.betas.size()) = clip.truth.motion.betas;
  const BodyPose start =
      PoseFromAxisAngle(body, clip.initialiser.poses.row(0).transpose(), clip.initialiser.trans.row(0).transpose());
  problem.states = {{start.rotations, start.trans}};
  problem.timestamps = {0};
  problem.cut_before = {0};
  FrameData frame;
  frame.Get<DenseTerm>().points = &clip.dense.frames[0];
  frame.Get<DenseTerm>().kernel = 8;
  frame.Get<PosePriorTerm>().mixture = std::make_shared<const MixturePrior>(BuiltinPosePrior(), body, joints);
  frame.Get<PosePriorTerm>().weight = options.prior_weight;
  problem.frames = {frame};
  const ObservedLandmarks no_landmarks;
  const LiftedStart not_lifted;
  const LiftedLandmarks none_lifted;
  const std::vector<ViewObservations> no_views;
  const std::unique_ptr<ClipTerm> rounds = MakeDenseRounds({.input = input,
                                                            .options = options,
                                                            .layout = problem.layout,
                                                            .landmarks = no_landmarks,
                                                            .joints = nullptr,
                                                            .lifted = not_lifted,
                                                            .lifted_landmarks = none_lifted,
                                                            .views = no_views});
  SolveOptions solve;
  solve.max_iterations = 60;
  solve.shape_constant = true;
  BasinResult result;
  const Stopwatch watch;
  const auto run = [&] { result.iterations += SolveSequence(&problem, solve).iterations; };
  if (method != "rendered UV") run();
  if (method != "reprojection") {
    if (rounds != nullptr) rounds->StartRound(0, {0}, &problem);
    run();
  }
  result.ms = 1e3 * watch.seconds();
  result.error_px = MeanProjectionErrorAt512(clip, problem.states[0]);
  return result;
}

void Basin(const BenchArguments& arguments, BenchReport* report) {
  constexpr double kSuccessPx = 4;
  report->label_columns = {"start_px", "residual"};
  report->value_columns = {"trials", "success_%", "median_px_of_successes", "iterations", "ms"};
  std::vector<int> joints(BuiltinBody().num_joints());
  std::iota(joints.begin(), joints.end(), 0);
  const std::vector<std::string> paths = arguments.List("motions");
  const int trials = arguments.Integer("trials");
  for (const std::string& start : arguments.List("starts")) {
    std::map<std::string, std::vector<BasinResult>> results;
    for (int trial = 0; trial < trials; ++trial) {
      const Motion motion = LoadMotion(paths[trial % paths.size()]);
      const int t = (trial * 97) % motion.num_frames();
      Motion one = motion;
      one.poses = motion.poses.row(t);
      one.trans = motion.trans.row(t);
      one.timestamps = {0};
      const SynthClip clip = MakeClip("densepose", one, std::stod(start), 1 + trial, arguments);
      for (const std::string method : {"reprojection", "rendered UV", "in turn"}) {
        results[method].push_back(SolveFrame(clip, method, joints));
      }
    }
    for (const std::string method : {"reprojection", "rendered UV", "in turn"}) {
      std::vector<double> good;
      double iterations = 0, ms = 0;
      for (const BasinResult& r : results[method]) {
        if (r.error_px < kSuccessPx) good.push_back(r.error_px);
        iterations += r.iterations / double(trials);
        ms += r.ms / trials;
      }
      std::sort(good.begin(), good.end());
      const double median = good.empty() ? std::numeric_limits<double>::quiet_NaN() : good[good.size() / 2];
      report->rows.push_back({"start " + start + " px",
                              {start, method},
                              {double(trials), 100.0 * double(good.size()) / trials, median, iterations, ms}});
      std::fprintf(stderr, "start %s px, %s: %.0f %%, %.2f px, %.1f ms\n", start.c_str(), method.c_str(),
                   report->rows.back().values[1], median, ms);
    }
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  std::string json;
  for (const std::string& what : arguments.List("what")) {
    BenchReport report;
    report.command = command;
    report.title = "Rendered UV and part labels: " + what;
    report.notes = {
        Concatenate("threads: ", arguments.Integer("threads"), ", keypoints a frame: ", arguments.Integer("dense"))};
    if (what == "dense") {
      DenseClips(arguments, &report);
    } else if (what == "basin") {
      Basin(arguments, &report);
    } else {
      BODYLOOM_CHECK(what == "labels", "--what is '", what, "', expected dense, basin or labels");
      LabelClips(arguments, &report);
    }
    std::fputs(BenchText(report).c_str(), stdout);
    json += (json.empty() ? "[" : ",") + BenchJson(report);
  }
  if (!arguments.Text("json").empty()) WriteFileAtomically(arguments.Text("json"), json + "]\n");
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  const std::string data = bodyloom::SharedDir() + "/data/aistpp/motions/";
  return bodyloom::BenchMain(
      "bodyloom_bench_rendered_uv", argc, argv,
      {{"what", "dense,basin,labels"},
       {"motions", data + "gBR_sBM_cAll_d06_mBR2_ch06.pkl," + data + "gJS_sBM_cAll_d03_mJS2_ch07.pkl"},
       {"noise", "pixel,uv,densepose"},
       {"dense", "300"},
       {"initial", "14.8"},
       {"fine_iterations", "8"},
       {"rounds", "1"},
       {"residuals", "reprojection,whitened,rendered UV"},
       {"min_cosine", "0.5"},
       {"frames", "0"},
       {"starts", "15,30,45,60"},
       {"trials", "60"},
       {"block", "1,6"},
       {"threads", "2"},
       {"json", ""}},
      bodyloom::Run);
}
