// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_lifter: error of the lifter alone on motion not seen in training.
///
///   bodyloom_bench_lifter --motions FOLDER[,FOLDER…] [--lifter built-in|FILE] [--windows 400]
///                         [--detections users|steady|exact] [--split test|train] [--json F]
///
/// Motion that the split keeps for testing (or, to tell overfitting, that it trains on), by class, as recorded, through
/// the generator's cameras and detectors (data_tools/synthesis/lifter); `--windows` random windows a class. Errors in
/// mm of a body with the mean body's torso + leg length: mean per-joint error of the 17 COCO landmarks relative to the
/// mid-hip (mpjpe), after a similarity (pa), of the limb hypotheses chosen by weight and by hindsight (best).
/// Reliability: landmarks sorted by the probability that the lifter gives to being within 50 mm, against the share that
/// is. Time: one thread, both runs (mirrored), a frame.
///
/// `--detections` tells what errors come from: users' detectors as in training (users), COCO-17 points that are all
/// there, from a known camera, with the measured noise (steady), or exact (exact).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "benchmarks/accuracy/lifter_oracle.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/synthesis/lifter/lifter_windows.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/procrustes.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/lifter/lifter_network.h"
#include "tracking/lifter/lifter_reading.h"

namespace bodyloom {
namespace {

constexpr double kRadius = 0.05;  ///< metres, of the reliability
constexpr int kBins = 10;
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

double MeanBodyLength() {
  BodyPose rest;
  rest.rotations.assign(BuiltinBody().num_joints(), Eigen::Matrix3d::Identity());
  const MatrixX3d points = PoseLandmarks(BuiltinBody(), Eigen::VectorXd(), rest, LifterPointNames());
  std::vector<float> coordinates;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (int c = 0; c < 3; ++c) coordinates.push_back(static_cast<float>(points(k, c)));
  }
  return LifterReferenceLength(coordinates);
}

LifterWindowOptions WindowOptions(const std::string& detections) {
  LifterWindowOptions options = LifterWindowOptions::AsRecorded();
  if (detections == "users") return options;
  BODYLOOM_CHECK(detections == "steady" || detections == "exact", "--detections is ", detections,
                 ", expected users, steady or exact");
  options.moving_camera = 0;
  options.focal_known = options.no_feet = 1;
  options.dropout = options.pair_swap = options.body_swap = options.no_face = 0;
  options.missing_limb = options.missing_lower_half = options.nothing = options.image_border = options.cut_off = 0;
  options.constant_confidence = options.confidence_spread = 0;
  if (detections == "exact") {
    options.noise = 0;
    options.biased_detector = options.landmark_sd_m = 0;
  }
  return options;
}

struct Errors {
  double joint = 0, aligned = 0, best = 0, depth = 0;
  int frames = 0;
};
struct Reliability {
  std::array<double, kBins> predicted{}, was{};
  std::array<int, kBins> count{};
};

class Scorer {
 public:
  Scorer(const LifterWeights& weights, double metres) : weights_(weights), metres_(metres) {}

  void Score(const LifterWindow& window, Errors* errors) {
    const auto T = static_cast<Eigen::Index>(window.features.size() / kLifterInputs);
    const RowMatrixXf features = Eigen::Map<const RowMatrixXf>(window.features.data(), T, kLifterInputs);
    const Stopwatch watch;
    const RowMatrixXf plain = RunLifter(weights_, features), mirrored = RunLifter(weights_, MirrorFeatures(features));
    std::vector<LiftedFrame> frames;
    for (Eigen::Index t = 0; t < T; ++t) {
      frames.push_back(ReadLifter(plain, mirrored, t, Eigen::Matrix3d::Identity()));
    }
    seconds_ += watch.seconds();
    frames_ += static_cast<int>(T);
    for (Eigen::Index t = 0; t < T; ++t) ScoreFrame(frames[t], &window.points[size_t(t) * 3 * kLifterPoints], errors);
  }
  [[nodiscard]] double MillisecondsAFrame() const { return 1e3 * seconds_ / std::max(1, frames_); }
  [[nodiscard]] const Reliability& reliability() const { return reliability_; }

 private:
  void ScoreFrame(const LiftedFrame& frame, const float* truth, Errors* errors) {
    MatrixX3d expected(17, 3);
    for (int k = 0; k < 17; ++k) {
      for (int c = 0; c < 3; ++c) expected(k, c) = metres_ * truth[3 * k + c];
    }
    const MatrixX3d predicted = metres_ * frame.points.topRows(17);
    LiftedFrame best = frame;
    for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
      const auto points = LifterOutput::LimbPoints(limb);
      const auto off = [&](const LiftedLimb& guess) {
        double sum = 0;
        for (int i = 0; i < 2; ++i) sum += (metres_ * guess.points[i].transpose() - expected.row(points[i])).norm();
        return sum;
      };
      SetLimb(limb,
              *std::min_element(frame.limbs[limb].begin(), frame.limbs[limb].end(),
                                [&](const LiftedLimb& a, const LiftedLimb& b) { return off(a) < off(b); }),
              &best);
    }
    errors->joint += (predicted - expected).rowwise().norm().mean();
    errors->best += (metres_ * best.points.topRows(17) - expected).rowwise().norm().mean();
    errors->depth += (predicted - expected).col(2).cwiseAbs().mean();
    errors->aligned +=
        (AlignPoints(predicted, expected).target_from_source.Apply(predicted) - expected).rowwise().norm().mean();
    ++errors->frames;
    for (int k = 0; k < 17; ++k) {
      double probability = ProbabilityWithin(kRadius / metres_, frame.sigma.row(k).transpose());
      for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
        const auto points = LifterOutput::LimbPoints(limb);
        const auto at = std::find(points.begin(), points.end(), k);
        if (at == points.end()) continue;
        // All hypotheses that put the landmark there count.
        probability = 0;
        for (const LiftedLimb& guess : frame.limbs[limb]) {
          const size_t i = static_cast<size_t>(at - points.begin());
          const double apart = metres_ * (guess.points[i].transpose() - frame.points.row(k)).norm();
          if (apart < kRadius) probability += guess.weight * ProbabilityWithin(kRadius / metres_, guess.sigma[i]);
        }
      }
      const int bin = std::clamp(static_cast<int>(probability * kBins), 0, kBins - 1);
      reliability_.predicted[bin] += probability;
      reliability_.was[bin] += (predicted.row(k) - expected.row(k)).norm() <= kRadius ? 1 : 0;
      ++reliability_.count[bin];
    }
  }

  const LifterWeights& weights_;
  double metres_;
  double seconds_ = 0;
  int frames_ = 0;
  Reliability reliability_;
};

void Run(const BenchArguments& arguments, const std::string& command) {
  MotionLibraryOptions library_options;
  const std::string split = arguments.Text("split");
  BODYLOOM_CHECK(split == "test" || split == "train", "--split is ", split, ", expected test or train");
  library_options.visit_train = split == "train";
  library_options.visit_test = split == "test";
  struct Set {
    std::vector<Motion> motions;
    std::vector<char> has_floor;
  };
  std::map<std::string, Set> classes;
  VisitMotionLibrary(arguments.List("motions"), library_options, [&](LibraryClip&& clip) {
    Set& set = classes[clip.motion_class];
    set.has_floor.push_back(clip.has_floor);
    set.motions.push_back(std::move(clip.motion));
  });
  const LifterWeights* weights = LifterOf(arguments.Text("lifter"));
  BODYLOOM_CHECK(weights != nullptr, "--lifter is none, expected built-in or a file");
  Scorer scorer(*weights, MeanBodyLength());
  BenchReport report;
  report.title = "The lifter alone, on motion kept for testing, synthetic detections";
  report.command = command;
  report.label_columns = {"class", "clips"};
  report.value_columns = {"pa_mpjpe_mm", "mpjpe_mm", "best_mm", "depth_mm"};
  const LifterWindowOptions options = WindowOptions(arguments.Text("detections"));
  for (const auto& [name, set] : classes) {
    const LifterWindowGenerator generator(set.motions, set.has_floor, BuiltinBody(), options);
    Errors errors;
    LifterWindow window;
    for (int i = 0; i < arguments.Integer("windows"); ++i) {
      generator.Generate(static_cast<uint64_t>(i), &window);
      scorer.Score(window, &errors);
    }
    BenchRow row;
    row.group = "by class of motion";
    row.labels = {name, std::to_string(set.motions.size())};
    for (const double sum : {errors.aligned, errors.joint, errors.best, errors.depth}) {
      row.values.push_back(1e3 * sum / std::max(1, errors.frames));
    }
    report.rows.push_back(row);
  }
  report.value_columns.insert(report.value_columns.end(), {"said_percent", "was_percent", "landmarks"});
  for (BenchRow& row : report.rows) row.values.resize(7, kNotMeasured);
  const Reliability& reliability = scorer.reliability();
  for (int bin = 0; bin < kBins; ++bin) {
    if (reliability.count[bin] == 0) continue;
    const double n = reliability.count[bin];
    BenchRow row;
    row.group = "within 50 mm";
    row.labels = {Concatenate(10 * bin, "-", 10 * bin + 10, " %"), ""};
    row.values = {kNotMeasured,
                  kNotMeasured,
                  kNotMeasured,
                  kNotMeasured,
                  100 * reliability.predicted[bin] / n,
                  100 * reliability.was[bin] / n,
                  n};
    report.rows.push_back(row);
  }
  report.notes = {Concatenate("lifter and reading, one thread: ", scorer.MillisecondsAFrame(), " ms a frame"),
                  Concatenate("weights: ", weights->num_parameters(), " numbers; ", weights->recipe)};
  HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_lifter", argc, argv,
                             {{"motions", bodyloom::SharedMotions()},
                              {"lifter", "built-in"},
                              {"windows", "200"},
                              {"detections", "users"},
                              {"split", "test"},
                              {"json", ""}},
                             bodyloom::Run);
}
