// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_limb_choice: gain of knowing each limb's correct hypothesis, and tests of whether the clip itself
/// reveals it.
///
///   bodyloom_bench_limb_choice [--data AISTPP] [--sequences A,B] [--views c02,c04,c06,c09] [--window 8] [--loose 20]
///                              [--rounds 3] [--json F]
///
/// AIST++ at 15 frames a second, the lifter run at the recording's rate, known focal length. A limb's hypotheses in a
/// window of frames are halved by depth, and the clip is solved three times: with the expected limb (the tracker), and
/// with the mean of the nearer and of the farther half in its place. Errors are the limb's two joints in that window,
/// mm, each frame aligned by one similarity:
///   expected      as the tracker does it
///   best          the best of the three, by hindsight
///   by cost       the one of lowest cost of the whole clip
///   by weight     the half that the lifter holds for likelier
///   by the rest   the half that costs less where the limb's own σ is multiplied by --loose, so that image, prior,
///   limits,
///                 smoothness and ground decide
/// Group "reweighed": hypotheses weighed again by how near the answer lies to each (exp(−½ τ d²), d in σ), --rounds
/// times; PA-MPJPE of the clip by τ.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/aist_evaluation.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "geometry/base/check.h"
#include "geometry/math/procrustes.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/paths.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/lifter/lift_keypoints.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr int kStride = 4;        // of the frames of AIST++, 60 a second
constexpr int kScoredPoints = 2;  // elbow and wrist, knee and ankle

/// A clip in one view at 15 frames a second, with what the lifter says at the full rate.
struct Clip {
  std::string sequence, view;
  Camera camera;
  KeypointSequence keypoints;
  std::vector<LiftedFrame> lifted;
  std::vector<MatrixX3d> truth;  ///< camera axes
  [[nodiscard]] int num_frames() const { return static_cast<int>(truth.size()); }
};

Clip ReadClip(const std::string& data, const MultiViewClip& truth, const std::string& view) {
  Clip clip;
  clip.sequence = truth.name, clip.view = view;
  const NamedCamera camera = FindCamera(LoadCameras(data + "/cameras", truth.name), view, data + "/cameras");
  clip.camera = camera.camera;
  LoadDetectionsOptions load;
  load.view = view;
  load.image_width = clip.camera.width, load.image_height = clip.camera.height;
  KeypointSequence all = LoadDetections(data + "/keypoints2d/" + truth.name + ".pkl", load);
  RepairSwaps(&all);
  const std::vector<LiftedFrame> lifted =
      LiftKeypoints(all, clip.camera, true, FindCuts(all), BuiltinLifter(), LiftOptions());
  clip.keypoints = all;
  clip.keypoints.points.clear(), clip.keypoints.timestamps.clear();
  const size_t count = std::min(lifted.size(), truth.coco17_in_world.size());
  for (size_t t = 0; t < count; t += kStride) {
    clip.keypoints.timestamps.push_back(all.timestamps[t]);
    for (int k = 0; k < all.num_points(); ++k) clip.keypoints.points.push_back(all.at(static_cast<int>(t), k));
    clip.lifted.push_back(lifted[t]);
    for (const RigView& rig_view : truth.views) {
      if (rig_view.name == view) clip.truth.push_back(MovedPoints(rig_view.pose, truth.coco17_in_world[t]));
    }
  }
  return clip;
}

struct Solved {
  double cost = 0, metres = 0;    ///< metres: the body's torso + leg length
  std::vector<MatrixX3d> joints;  ///< COCO-17, camera axes
};

Solved Solve(const Clip& clip, const std::vector<LiftedFrame>& lifted) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.keypoints = &clip.keypoints;
  input.camera = clip.camera;
  input.lifted = &lifted;
  TrackSequenceOptions options;
  options.camera_knowledge = CameraKnowledge::kKnown;
  options.estimate_uncertainty = false;
  options.fit_smoothness = false;  // one law for all candidates: their costs are compared
  const TrackSequenceResult result = FitClip(input, options);
  return {result.summary.final_cost, LifterMetres(BuiltinBody(), result.track.motion.betas), result.track.coco17};
}

/// Distances of aligned joints, mm: of a limb's two in the frames [begin, end), or of all (limb −1).
double ErrorOf(const Clip& clip, const Solved& solved, int limb, int begin, int end) {
  double sum = 0;
  int count = 0;
  for (int t = begin; t < end; ++t) {
    const MatrixX3d& truth = clip.truth[static_cast<size_t>(t)];
    if (!truth.allFinite()) continue;
    const MatrixX3d& found = solved.joints[static_cast<size_t>(t)];
    const MatrixX3d aligned = AlignPoints(found, truth).target_from_source.Apply(found);
    const int points = limb < 0 ? static_cast<int>(truth.rows()) : kScoredPoints;
    for (int i = 0; i < points; ++i) {
      const int k = limb < 0 ? i : LifterOutput::LimbPoints(limb)[static_cast<size_t>(i)];
      sum += (aligned.row(k) - truth.row(k)).norm();
      ++count;
    }
  }
  return count > 0 ? 1e3 * sum / count : kNotMeasured;
}

/// The means of a frame's nearer and farther hypotheses of a limb; their weights.
std::array<LiftedLimb, 2> Halves(const LiftedFrame& frame, int limb) {
  const Vector3d away = frame.camera_from_virtual.col(2);
  const auto depth = [&](const LiftedLimb& guess) { return (guess.points[0] + guess.points[1]).dot(away); };
  double mean = 0;
  for (const LiftedLimb& guess : frame.limbs[static_cast<size_t>(limb)]) mean += guess.weight * depth(guess);
  std::array<std::vector<LiftedLimb>, 2> guesses;
  for (const LiftedLimb& guess : frame.limbs[static_cast<size_t>(limb)]) guesses[depth(guess) > mean].push_back(guess);
  std::array<LiftedLimb, 2> halves;
  for (size_t half = 0; half < 2; ++half) {
    double weight = 0;
    for (const LiftedLimb& guess : guesses[half]) weight += guess.weight;
    for (LiftedLimb& guess : guesses[half]) guess.weight /= weight;
    halves[half] = guesses[half].empty() ? MeanLimb(frame.limbs[static_cast<size_t>(limb)], frame.camera_from_virtual)
                                         : MeanLimb(guesses[half], frame.camera_from_virtual);
    halves[half].weight = weight;
  }
  return halves;
}

/// One limb in one window.
struct Choice {
  double expected = 0, best = 0, by_cost = 0, by_weight = 0, by_rest = 0;
};

Choice Choose(const Clip& clip, const Solved& expected, int limb, int begin, int end, double loose) {
  std::array<std::vector<LiftedFrame>, 2> tight = {clip.lifted, clip.lifted}, wide;
  double nearer_weight = 0;
  for (int t = begin; t < end; ++t) {
    const std::array<LiftedLimb, 2> halves = Halves(clip.lifted[static_cast<size_t>(t)], limb);
    nearer_weight += halves[0].weight / (end - begin);
    for (size_t half = 0; half < 2; ++half) SetLimb(limb, halves[half], &tight[half][static_cast<size_t>(t)]);
  }
  wide = tight;
  std::array<double, 3> cost = {expected.cost, 0, 0}, error = {ErrorOf(clip, expected, limb, begin, end), 0, 0}, rest{};
  for (size_t half = 0; half < 2; ++half) {
    for (int t = begin; t < end; ++t) {
      for (const int k : LifterOutput::LimbPoints(limb)) wide[half][static_cast<size_t>(t)].sigma.row(k) *= loose;
    }
    const Solved solved = Solve(clip, tight[half]);
    cost[half + 1] = solved.cost;
    error[half + 1] = ErrorOf(clip, solved, limb, begin, end);
    rest[half] = Solve(clip, wide[half]).cost;
  }
  const auto lowest = std::min_element(cost.begin(), cost.end()) - cost.begin();
  return {error[0], *std::min_element(error.begin(), error.end()), error[static_cast<size_t>(lowest)],
          nearer_weight >= 0.5 ? error[1] : error[2], rest[0] <= rest[1] ? error[1] : error[2]};
}

/// The clip's hypotheses weighed by their distance from an answer.
std::vector<LiftedFrame> Reweighed(const Clip& clip, const Solved& solved, double tau) {
  constexpr double kMinSigma = 0.03;
  std::vector<LiftedFrame> frames = clip.lifted;
  for (size_t t = 0; t < frames.size(); ++t) {
    const Eigen::RowVector3d hip = 0.5 * (solved.joints[t].row(11) + solved.joints[t].row(12));
    const Eigen::Matrix3d& axes = clip.lifted[t].camera_from_virtual;
    for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
      std::vector<LiftedLimb> guesses = clip.lifted[t].limbs[static_cast<size_t>(limb)];
      double sum = 0;
      for (LiftedLimb& guess : guesses) {
        double squared = 0;
        for (size_t i = 0; i < kScoredPoints; ++i) {
          const Eigen::RowVector3d found = solved.joints[t].row(LifterOutput::LimbPoints(limb)[i]) - hip;
          const Vector3d off = axes.transpose() * (found.transpose() / solved.metres - guess.points[i]);
          const Eigen::Vector2d sigma = guess.sigma[i].cwiseMax(kMinSigma);
          squared += off.head<2>().squaredNorm() / (sigma.x() * sigma.x()) + std::pow(off.z() / sigma.y(), 2);
        }
        sum += guess.weight *= std::exp(-0.5 * tau * squared);
      }
      if (!(sum > 0)) continue;
      for (LiftedLimb& guess : guesses) guess.weight /= sum;
      SetLimb(limb, MeanLimb(guesses, axes), &frames[t]);
    }
  }
  return frames;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  const int window = arguments.Integer("window"), rounds = arguments.Integer("rounds");
  const double loose = std::stod(arguments.Text("loose"));
  BODYLOOM_CHECK(window > 0 && rounds > 0 && loose > 0, "--window, --rounds and --loose: expected numbers above 0");
  const std::array<double, 4> taus = {0.02, 0.05, 0.1, 0.3};
  BenchReport report;
  report.title = "Hypotheses of limbs: the best by hindsight, and what would choose it";
  report.command = command;
  report.label_columns = {"clip", "camera", "limbs"};
  report.value_columns = {"expected_mm", "best_mm", "by_cost_mm", "by_weight_mm", "by_rest_mm"};
  BenchReport reweighed = report;
  reweighed.title = "Hypotheses of limbs, weighed again by the answer: PA-MPJPE";
  reweighed.label_columns = {"clip", "camera"};
  reweighed.value_columns = {"once_mm"};
  for (const double tau : taus) reweighed.value_columns.push_back(Concatenate("tau_", tau));
  for (const std::string& sequence : arguments.List("sequences")) {
    const MultiViewClip truth = ReadAistClip(arguments.Text("data"), arguments.Text("data") + "/cameras", sequence);
    for (const std::string& view : arguments.List("views")) {
      const Clip clip = ReadClip(arguments.Text("data"), truth, view);
      const Solved expected = Solve(clip, clip.lifted);
      for (const int first_limb : {0, 2}) {
        std::vector<double> sums(report.value_columns.size(), 0);
        int count = 0;
        for (int begin = 0; begin < clip.num_frames(); begin += window) {
          const int end = std::min(clip.num_frames(), begin + window);
          for (const int limb : {first_limb, first_limb + 1}) {
            const Choice choice = Choose(clip, expected, limb, begin, end, loose);
            if (!std::isfinite(choice.expected)) continue;
            const std::array<double, 5> values = {choice.expected, choice.best, choice.by_cost, choice.by_weight,
                                                  choice.by_rest};
            for (size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
            ++count;
          }
        }
        for (double& sum : sums) sum /= std::max(1, count);
        report.rows.push_back({first_limb == 0 ? "arms" : "legs",
                               {clip.sequence.substr(0, 3), view, first_limb == 0 ? "arms" : "legs"},
                               sums});
      }
      BenchRow row{
          "reweighed", {clip.sequence.substr(0, 3), view}, {ErrorOf(clip, expected, -1, 0, clip.num_frames())}};
      for (const double tau : taus) {
        Solved solved = expected;
        for (int round = 0; round < rounds; ++round) solved = Solve(clip, Reweighed(clip, solved, tau));
        row.values.push_back(ErrorOf(clip, solved, -1, 0, clip.num_frames()));
      }
      reweighed.rows.push_back(row);
      std::fprintf(stderr, "%s %s\n", clip.sequence.c_str(), view.c_str());
    }
  }
  HandOver(report, arguments.Text("json"));
  HandOver(reweighed, "");
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_limb_choice", argc, argv,
                             {{"data", bodyloom::SharedDir() + "/data/aistpp"},
                              {"sequences", "gBR_sBM_cAll_d06_mBR2_ch06,gJS_sBM_cAll_d03_mJS2_ch07"},
                              {"views", "c02,c04,c06,c09"},
                              {"window", "8"},
                              {"loose", "20"},
                              {"rounds", "3"},
                              {"json", ""}},
                             bodyloom::Run);
}
