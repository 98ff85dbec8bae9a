// SPDX-License-Identifier: Apache-2.0
#include "tracking/track_sequence.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <thread>

#include "geometry/check.h"
#include "geometry/posed_body.h"
#include "geometry/rotation.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/observability.h"
#include "tracking/sequence_problem.h"
#include "tracking/track_result.h"
#include "tracking/uncertainty.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

class StageClock {
 public:
  explicit StageClock(TrackSequenceSummary* summary) : summary_(summary) {}
  /// Books the time since the last call under `stage`.
  void Book(const std::string& stage) {
    const auto now = std::chrono::steady_clock::now();
    summary_->seconds.emplace_back(stage, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  TrackSequenceSummary* summary_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void CheckInput(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "track: ", why);
  BODYLOOM_CHECK(input.body != nullptr, "track: no body");
  BODYLOOM_CHECK(input.keypoints != nullptr || input.dense != nullptr,
                 "track: neither 2D joints nor dense keypoints; give at least one");
  const int frames = input.keypoints != nullptr ? input.keypoints->num_frames() : input.dense->num_frames();
  BODYLOOM_CHECK(frames > 0, "track: the detections hold no frames");
  if (input.keypoints != nullptr && input.dense != nullptr) {
    BODYLOOM_CHECK(input.keypoints->num_frames() == input.dense->num_frames(), "track: ", input.keypoints->num_frames(),
                   " frames of 2D joints but ", input.dense->num_frames(), " of dense keypoints");
  }
  if (input.initialiser != nullptr) {
    BODYLOOM_CHECK(input.initialiser->num_frames() == frames, "track: the initialiser has ",
                   input.initialiser->num_frames(), " frames, the detections ", frames);
  }
  if (input.dense != nullptr) {
    for (const auto& frame : input.dense->frames) {
      for (const DenseKeypoint& point : frame) {
        BODYLOOM_CHECK(point.face >= 0 && point.face < input.body->num_faces(), "track: a dense keypoint names face ",
                       point.face, ", the body '", input.body->name(), "' has ", input.body->num_faces());
      }
    }
  }
  const int width = input.keypoints != nullptr ? input.keypoints->image_width : input.dense->image_width;
  const int height = input.keypoints != nullptr ? input.keypoints->image_height : input.dense->image_height;
  if (options.camera_knowledge == CameraKnowledge::kKnown) {
    BODYLOOM_CHECK(input.camera.fx > 0 && input.camera.fy > 0, "track: the camera's focal length is ", input.camera.fx,
                   ", expected a positive number of pixels");
    BODYLOOM_CHECK(
        width == 0 || input.camera.width == 0 || (width == input.camera.width && height == input.camera.height),
        "track: the detections are for images of ", width, "x", height, " but the camera is for ", input.camera.width,
        "x", input.camera.height);
  } else {
    BODYLOOM_CHECK(width > 0 || input.camera.width > 0,
                   "track: the image size is not known; it is needed when the focal length is not");
  }
}

/// The camera the problem starts with. An unknown focal length starts at 0.9 of the longer side (58° field of view).
Camera StartCamera(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (options.camera_knowledge == CameraKnowledge::kKnown) return input.camera;
  const int width = input.camera.width > 0       ? input.camera.width
                    : input.keypoints != nullptr ? input.keypoints->image_width
                                                 : input.dense->image_width;
  const int height = input.camera.height > 0      ? input.camera.height
                     : input.keypoints != nullptr ? input.keypoints->image_height
                                                  : input.dense->image_height;
  return MakePinhole(width, height, 0.9 * std::max(width, height));
}

const std::vector<double>& Timestamps(const TrackSequenceInput& input) {
  return input.keypoints != nullptr ? input.keypoints->timestamps : input.dense->timestamps;
}

/// Image height of an upright body at each frame's depth, pixels: the yardstick of detection noise.
double BodyHeightPx(const FrameLayout& layout, const FrameState& state, double stature) {
  if (layout.knowledge == CameraKnowledge::kWeak) return std::exp(state.translation[0]) * stature;
  return layout.camera.fy * stature / std::max(state.translation.z(), 0.3);
}

}  // namespace

bool TrackSequenceOptions::IsValid(std::string* why) const {
  if (solver != "ceres") {
    *why = "solver '" + solver + "' is unknown; expected 'ceres'";
    return false;
  }
  if (num_threads < 0 || num_threads > 256) {
    *why = "num_threads is " + std::to_string(num_threads) + ", expected 0 (all cores) to 256";
    return false;
  }
  if (max_iterations < 1) {
    *why = "max_iterations is " + std::to_string(max_iterations) + ", expected at least 1";
    return false;
  }
  if (!(initialiser_weight >= 0)) {
    *why = "initialiser_weight is " + std::to_string(initialiser_weight) + ", expected 0 or more";
    return false;
  }
  return true;
}

std::string ToString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kFailure:
      return "failure";
    case SolveStatus::kConverged:
      return "converged";
    case SolveStatus::kMaxIterations:
      return "max_iterations";
    case SolveStatus::kStopped:
      return "stopped";
  }
  return "failure";
}

TrackSequenceResult TrackSequence(const TrackSequenceInput& given, const TrackSequenceOptions& options) {
  CheckInput(given, options);
  const BodyModel& model = *given.body;
  TrackSequenceResult result;
  TrackSequenceSummary& summary = result.summary;
  TrackSequenceInput input = given;
  KeypointSequence repaired;
  if (given.keypoints != nullptr) {
    repaired = *given.keypoints;
    summary.num_swaps_repaired = RepairSwaps(&repaired);
    input.keypoints = &repaired;
  }
  summary.solver = options.solver;
  summary.plan = PlanTrackSequence(input, options);
  StageClock clock(&summary);
  const int threads = options.num_threads > 0 ? options.num_threads : std::max(1u, std::thread::hardware_concurrency());

  // Which landmarks and joints take part.
  const int num_betas = options.estimate_shape ? std::min(model.num_betas(), 10) : 0;
  const ObservedLandmarks landmarks = FindObservedLandmarks(model, input.keypoints, num_betas);
  const std::vector<int> active = FindActiveJoints(model, landmarks, input.dense != nullptr, options.skip_unneeded);
  const Camera camera = StartCamera(input, options);
  SequenceProblem problem;
  problem.layout = FrameLayout::Make(model, options.camera_knowledge, camera, active, num_betas);
  problem.timestamps = Timestamps(input);
  const size_t T = problem.timestamps.size();
  problem.cut_before = input.keypoints != nullptr ? FindCuts(*input.keypoints) : std::vector<char>(T, 0);
  problem.betas = VectorXd::Zero(num_betas);
  problem.log_focal = problem.log_focal_prior = std::log(camera.fx);
  std::optional<MixturePrior> prior;
  if (input.prior != nullptr && input.prior->num_components() > 0) prior.emplace(*input.prior, model, active);
  const JointLimits limits = JointLimits::ForBody(model);

  // Starting poses.
  if (options.progress && !options.progress({"initialise", 0.0, 0.0})) {
    summary.status = SolveStatus::kStopped;
  }
  const InitialStates initial = FindInitialStates(input, problem.layout, options);
  if (initial.states.empty()) {
    summary.message =
        "no frame shows enough of the body to start from: a shoulder and a hip are needed, with some confidence";
    return result;
  }
  problem.states = initial.states;
  problem.betas = initial.betas;
  problem.shape_prior.mean = initial.betas;
  clock.Book("initialise");

  // Observations.
  VectorXd stature_gradient;
  const double stature = StatureOfMeanShape(model, num_betas, &stature_gradient);
  problem.frames.resize(T);
  for (size_t t = 0; t < T; ++t) {
    FrameData& frame = problem.frames[t];
    if (input.keypoints != nullptr) {
      const double height_px = BodyHeightPx(problem.layout, problem.states[t], stature);
      frame.landmarks = ObserveLandmarks(landmarks, *input.keypoints, static_cast<int>(t), height_px);
    }
    if (input.dense != nullptr) frame.dense = &input.dense->frames[t];
    if (prior) {
      frame.prior = &*prior;
      frame.prior_weight = options.prior_weight;
    }
    frame.limits = &limits;
    frame.upright_weight = options.upright_weight;
    frame.initial_rotations = problem.states[t].rotations;
    frame.initial_translation = problem.states[t].translation;
    summary.num_observations +=
        static_cast<int>(frame.landmarks.size()) + (frame.dense != nullptr ? static_cast<int>(frame.dense->size()) : 0);
  }
  // Detections of a frame and of its neighbours err together (COCO joints are not the body's, and detectors are off for
  // a third of a second at a time), so frames do not outvote the shape prior as independent measurements would.
  problem.shape_prior.weight = std::max(1.0, options.shape_prior_weight * static_cast<double>(T));
  summary.num_parameters = static_cast<int>(T) * problem.layout.num_frame_columns() + problem.layout.num_columns -
                           problem.layout.beta_column;

  const bool pulled = input.initialiser == nullptr;
  const auto solve = [&](const char* stage, SequenceProblem* stage_problem, double pull, double kernel,
                         double tolerance, int max_iterations, double from, double to) {
    for (FrameData& frame : stage_problem->frames) {
      frame.initialiser_weight = pull;
      frame.landmark_kernel = kernel;
    }
    SolveOptions solve_options;
    solve_options.max_iterations = max_iterations;
    solve_options.num_threads = threads;
    solve_options.function_tolerance = tolerance;
    if (options.progress) {
      solve_options.on_iteration = [&, from, to, stage](int iteration, double cost) {
        const double done = 1 - std::exp(-iteration / 6.0);
        return options.progress({stage, from + (to - from) * done, cost});
      };
    }
    const SolveReport report = SolveSequence(stage_problem, solve_options);
    summary.iterations += report.iterations;
    summary.seconds_evaluation += report.seconds_evaluation;
    summary.seconds_linear_solver += report.seconds_linear_solver;
    if (summary.initial_cost == 0) summary.initial_cost = report.initial_cost;
    summary.final_cost = report.final_cost;
    summary.status = report.status;
    summary.message = report.message;
    clock.Book(stage);
    return report.status != SolveStatus::kFailure && report.status != SolveStatus::kStopped;
  };
  // Coarse in time first: what a frame cannot decide alone its neighbours decide together, and 15 frames a second are
  // enough to see how a person moves.
  bool going = true;
  const std::vector<int> coarse_frames = FramesAtRate(problem, options.coarse_rate);
  const bool coarse_to_fine = coarse_frames.size() < T;
  const double final_pull = pulled ? 0.0 : options.initialiser_weight;
  if (pulled || coarse_to_fine) {
    SequenceProblem coarse = SelectFrames(problem, coarse_frames);
    if (pulled)
      going = solve("fit near start", &coarse, options.start_pull, 8, 1e-3, options.max_iterations, 0.05, 0.3);
    if (going) going = solve("fit coarse", &coarse, final_pull, 4, 1e-4, options.max_iterations, 0.3, 0.6);
    SpreadFrames(coarse, coarse_frames, &problem);
  }
  // The coarse solve has settled what is slow to settle; between its frames a few steps are enough.
  const int fine_iterations = coarse_to_fine ? options.max_fine_iterations : options.max_iterations;
  if (going) solve("fit", &problem, final_pull, 4, 1e-4, fine_iterations, 0.6, 0.95);

  FillTrack(input, problem, landmarks, &result);
  clock.Book("finish");
  if (options.estimate_uncertainty) {
    // On the coarse frames: neighbours' detection errors are not independent, and their joints' spread changes slowly.
    const RowMatrixXd sigma = JointPositionSigma(SelectFrames(problem, coarse_frames));
    for (size_t i = 0, t = 0; t < T; ++t) {
      while (i + 1 < coarse_frames.size() &&
             std::abs(problem.timestamps[coarse_frames[i + 1]] - problem.timestamps[t]) <=
                 std::abs(problem.timestamps[coarse_frames[i]] - problem.timestamps[t])) {
        ++i;
      }
      result.track.joint_sigma.row(t) = sigma.row(i);
    }
    clock.Book("uncertainty");
  }
  return result;
}

}  // namespace bodyloom
