// SPDX-License-Identifier: Apache-2.0
/// Convergence basin of the solve: success rate against initial error.
///
///   bodyloom_bench_convergence [--starts 20] [--frames 4] [--solver ceres] [--json F] [--markdown F]
///
/// Synthetic clips of the demo motion (15 frames a second, detections as a detector makes them), started from the true
/// poses with an error of exactly d degrees about a random axis, constant over the clip, and nothing that pulls back to
/// the start (initialiser_weight 0):
///   root    the whole person is turned about the pelvis
///   limbs   every shoulder, elbow, hip and knee is turned, each about an axis of its own
/// A solve succeeds when its mean joint error, pelvis on pelvis, is within 20 mm of what the same clip reaches from its
/// true poses. Every cell has the same axes for every engine and version.
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/evaluation/metrics.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/percentile.h"
#include "geometry/base/stopwatch.h"
#include "geometry/math/rotation.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

constexpr std::array<int, 9> kStart_deg = {0, 15, 30, 45, 60, 75, 90, 120, 150};
constexpr double kSuccess_m = 0.02;
/// SMPL's shoulders, elbows, hips and knees.
constexpr std::array<int, 8> kLimbJoints = {16, 17, 18, 19, 1, 2, 4, 5};

Eigen::Vector3d RandomAxis(HashRandom* random) {
  Eigen::Vector3d axis;
  do {
    axis = {random->Normal(), random->Normal(), random->Normal()};
  } while (axis.norm() < 1e-3);
  return axis.normalized();
}

/// `motion` with joint j turned: in the camera frame for the root, in its own frame for others.
void Turn(int j, const Eigen::Matrix3d& turn, Motion* motion) {
  for (int t = 0; t < motion->num_frames(); ++t) {
    const Eigen::Matrix3d R = RotationFromAxisAngle(motion->poses.row(t).segment<3>(3 * j).transpose());
    motion->poses.row(t).segment<3>(3 * j) = AxisAngleFromRotation(j == 0 ? turn * R : R * turn).transpose();
  }
}

/// One clip with what it reaches from its true poses.
struct Problem {
  SynthClip clip;
  bool dense = false;
  double floor_m = 0;
};

struct Outcome {
  double error_m = 0, seconds = 0;
  int iterations = 0;
};

Outcome Solve(const Problem& problem, const Motion& start, const std::string& solver) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.prior = &BuiltinPosePrior();
  input.keypoints = &problem.clip.keypoints;
  input.dense = problem.dense ? &problem.clip.dense : nullptr;
  input.camera = problem.clip.truth.camera;
  input.initialiser = &start;
  TrackSequenceOptions options;
  options.solver = SequenceSolverFromString(solver);
  options.num_threads = 1;
  options.initialiser_weight = 0;
  options.max_iterations = 100;
  options.estimate_uncertainty = false;
  const Stopwatch watch;
  const TrackSequenceResult result = FitClip(input, options);
  Outcome outcome;
  outcome.seconds = watch.seconds();
  outcome.iterations = result.summary.iterations;
  outcome.error_m = std::numeric_limits<double>::infinity();  // a failure
  if (result.summary.IsUsable()) {
    const std::vector<MatrixX3d>&found = result.track.joints, &truth = problem.clip.truth.joints;
    outcome.error_m =
        MeanPositionError(RelativeTo(found, RootPositions(found, {0})), RelativeTo(truth, RootPositions(truth, {0})))
            .mean;
  }
  return outcome;
}

std::vector<Problem> MakeProblems(int frames, bool dense, const std::string& solver) {
  std::vector<Problem> problems;
  const Motion motion = DemoMotion(BuiltinBody(), 90, 15);
  for (const int first : {10, 40, 60, 75}) {
    Motion piece;
    piece.body = motion.body;
    piece.poses = motion.poses.middleRows(first, frames);
    piece.trans = motion.trans.middleRows(first, frames);
    for (int t = 0; t < frames; ++t) piece.timestamps.push_back(t / 15.0);
    SynthClipOptions options;
    options.seed = static_cast<uint64_t>(first);
    options.dense_per_frame = dense ? 200 : 0;
    options.dense.pixel_sigma_px = dense ? 2 : 0;
    Problem problem;
    problem.clip = MakeSynthClip(BuiltinBody(), piece, options);
    problem.dense = dense;
    problem.floor_m = Solve(problem, problem.clip.truth.motion, solver).error_m;
    problems.push_back(std::move(problem));
  }
  return problems;
}

/// The report's rows as one Markdown table.
std::string Markdown(const BenchReport& report) {
  std::ostringstream out;
  out << "| observations | turned | start ° | success % | median error mm | iterations | s a solve |\n"
         "|---|---|---|---|---|---|---|\n";
  for (const BenchRow& row : report.rows) {
    out << "| " << row.group << " | " << row.labels[0] << " | " << row.labels[1];
    for (size_t i = 0; i < row.values.size(); ++i) {
      char number[32];
      std::snprintf(number, sizeof(number), i == 3 ? "%.2f" : i == 1 ? "%.1f" : "%.0f", row.values[i]);
      out << " | " << number;
    }
    out << " |\n";
  }
  return out.str();
}

void Run(const BenchArguments& arguments, const std::string& command) {
  const int starts = arguments.Integer("starts"), frames = arguments.Integer("frames");
  BODYLOOM_CHECK(starts >= 1 && frames >= 1 && frames <= 15, "--starts is ", starts, " and --frames ", frames,
                 ", expected at least 1, and 1 to 15");
  const std::string solver = arguments.Text("solver");
  BenchReport report;
  report.title = "Convergence: success rate against starting error";
  report.command = command;
  report.label_columns = {"turned", "start_deg"};
  report.value_columns = {"success_percent", "median_error_mm", "median_iterations", "median_seconds"};
  report.summarise = false;
  report.notes = {Concatenate("solver ", solver, ", ", starts, " starts a row over 4 clips of ", frames,
                              " frames, one thread; success: within 20 mm of the answer from the true poses")};
  for (const bool dense : {false, true}) {
    const std::vector<Problem> problems = MakeProblems(frames, dense, solver);
    const std::string group = dense ? "2D joints and 200 dense keypoints" : "2D joints";
    for (const bool limbs : {false, true}) {
      for (const int degrees : kStart_deg) {
        std::vector<double> errors, iterations, seconds;
        int successes = 0;
        for (int i = 0; i < starts; ++i) {
          const Problem& problem = problems[static_cast<size_t>(i) % problems.size()];
          HashRandom random(7, {static_cast<uint64_t>(i), limbs ? 1U : 0U});
          Motion start = problem.clip.truth.motion;
          const double angle = degrees * M_PI / 180;
          if (limbs) {
            for (const int j : kLimbJoints) Turn(j, RotationFromAxisAngle(angle * RandomAxis(&random)), &start);
          } else {
            Turn(0, RotationFromAxisAngle(angle * RandomAxis(&random)), &start);
          }
          const Outcome outcome = Solve(problem, start, solver);
          successes += outcome.error_m <= problem.floor_m + kSuccess_m ? 1 : 0;
          errors.push_back(1e3 * outcome.error_m);
          iterations.push_back(outcome.iterations);
          seconds.push_back(outcome.seconds);
        }
        report.rows.push_back({group,
                               {limbs ? "limbs" : "root", std::to_string(degrees)},
                               {100.0 * successes / starts, Percentile(errors, 50), Percentile(iterations, 50),
                                Percentile(seconds, 50)}});
        std::fprintf(stderr, "%s, %s, %d deg: %d of %d\n", group.c_str(), limbs ? "limbs" : "root", degrees, successes,
                     starts);
      }
    }
  }
  HandOver(report, arguments.Text("json"));
  if (!arguments.Text("markdown").empty()) WriteFileAtomically(arguments.Text("markdown"), Markdown(report));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_convergence", argc, argv,
                             {{"starts", "20"}, {"frames", "4"}, {"solver", "ceres"}, {"json", ""}, {"markdown", ""}},
                             bodyloom::Run);
}
