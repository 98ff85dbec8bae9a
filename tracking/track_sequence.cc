// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/track_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <thread>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/in_range.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/rotation.h"
#include "bodyloom/tracking/ground_terms.h"
#include "bodyloom/tracking/image_terms.h"
#include "bodyloom/tracking/initialise/impossible_frames.h"
#include "bodyloom/tracking/initialise/initial_states.h"
#include "bodyloom/tracking/initialise/lifted_start.h"
#include "bodyloom/tracking/initialise/swap_repair.h"
#include "bodyloom/tracking/input_checks.h"
#include "bodyloom/tracking/motion_level.h"
#include "bodyloom/tracking/observability.h"
#include "bodyloom/tracking/residuals/lifted_pose.h"
#include "bodyloom/tracking/sequence_problem.h"
#include "bodyloom/tracking/track_result.h"
#include "bodyloom/tracking/uncertainty.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Length and image size of the clip, from whichever observations there are.
struct ClipExtent {
  int frames = 0, width = 0, height = 0;
  const std::vector<double>* timestamps = nullptr;
};

ClipExtent ExtentOf(const TrackSequenceInput& input) {
  ClipExtent extent;
  const char* first = nullptr;
  const auto add = [&](const auto* observations, const char* what) {
    if (observations == nullptr) return;
    if (first == nullptr) {
      first = what;
      extent.frames = observations->num_frames();
      extent.timestamps = &observations->timestamps;
    }
    BODYLOOM_CHECK(observations->num_frames() == extent.frames, "track: ", extent.frames, " frames of ", first, " but ",
                   observations->num_frames(), " of ", what);
    const int w = observations->image_width, h = observations->image_height;
    if (w == 0) return;
    BODYLOOM_CHECK(extent.width == 0 || (extent.width == w && extent.height == h), "track: the ", what,
                   " are for images of ", w, "x", h, ", other observations for ", extent.width, "x", extent.height);
    extent.width = w;
    extent.height = h;
  };
  add(input.keypoints, "2D joints");
  add(input.dense, "dense keypoints");
  add(input.part_labels, "part labels");
  return extent;
}

void CheckDense(const TrackSequenceInput& input) {
  for (const auto& frame : input.dense->frames) {
    for (const DenseKeypoint& point : frame) {
      BODYLOOM_CHECK(point.face >= 0 && point.face < input.body->num_faces(), "track: a dense keypoint names face ",
                     point.face, ", the body '", input.body->name(), "' has ", input.body->num_faces());
    }
  }
}

void CheckPartLabels(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const PartLabelSequence& labels = *input.part_labels;
  BODYLOOM_CHECK(static_cast<int>(labels.timestamps.size()) == labels.num_frames(), "track: ", labels.num_frames(),
                 " frames of part labels but ", labels.timestamps.size(), " timestamps");
  BODYLOOM_CHECK(labels.image_width > 0 && labels.image_height > 0,
                 "track: the part labels do not say how large their images are");
  const bool alone = input.keypoints == nullptr && input.dense == nullptr;
  BODYLOOM_CHECK(!alone || input.initialiser != nullptr,
                 "track: part labels refine a start; give 2D joints, dense keypoints or an initialiser with them");
  BODYLOOM_CHECK(!alone || options.camera_knowledge != CameraKnowledge::kWeak,
                 "track: weak perspective needs 2D joints or dense keypoints besides part labels");
  std::array<bool, 256> has_chart{};
  if (!input.body->has_parts()) has_chart[labels.part_of_chart[0]] = true;
  for (const uint8_t chart : input.body->data().face_part) has_chart[labels.part_of_chart[chart]] = true;
  has_chart[PartLabelSequence::kBackground] = has_chart[PartLabelSequence::kUnknown] = true;
  for (int t = 0; t < labels.num_frames(); ++t) {
    const LabelImage& image = labels.frames[t];
    const size_t expected = size_t(std::max(image.width, 0)) * size_t(std::max(image.height, 0));
    BODYLOOM_CHECK(image.labels.size() == expected, "track: frame ", t, " holds ", image.labels.size(),
                   " part labels for ", image.width, "x", image.height, " pixels");
    BODYLOOM_CHECK(expected == 0 ||
                       (image.x_begin >= 0 && image.y_begin >= 0 && image.x_begin <= labels.image_width - image.width &&
                        image.y_begin <= labels.image_height - image.height),
                   "track: the part labels of frame ", t, " cover ", image.width, "x", image.height, " pixels from (",
                   image.x_begin, ", ", image.y_begin, "), outside the image of ", labels.image_width, "x",
                   labels.image_height);
    for (const uint8_t label : image.labels) {
      BODYLOOM_CHECK(has_chart[labels.part_of_label[label]], "track: frame ", t, " has pixels of label ", int{label},
                     " (part ", int{labels.part_of_label[label]}, "), which no chart of the body '", input.body->name(),
                     "' belongs to");
    }
  }
}

void CheckInput(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "track: ", why);
  BODYLOOM_CHECK(input.body != nullptr, "track: no body");
  BODYLOOM_CHECK(input.keypoints != nullptr || input.dense != nullptr || input.part_labels != nullptr,
                 "track: neither 2D joints nor dense keypoints nor part labels; give at least one");
  const ClipExtent extent = ExtentOf(input);
  BODYLOOM_CHECK(extent.frames > 0, "track: the detections hold no frames");
  if (input.initialiser != nullptr) {
    BODYLOOM_CHECK(input.initialiser->num_frames() == extent.frames, "track: the initialiser has ",
                   input.initialiser->num_frames(), " frames, the detections ", extent.frames);
  }
  if (input.dense != nullptr) CheckDense(input);
  if (input.part_labels != nullptr) CheckPartLabels(input, options);
  if (options.camera_knowledge == CameraKnowledge::kKnown) {
    BODYLOOM_CHECK(extent.width == 0 || input.camera.width == 0 ||
                       (extent.width == input.camera.width && extent.height == input.camera.height),
                   "track: the detections are for images of ", extent.width, "x", extent.height,
                   " but the camera is for ", input.camera.width, "x", input.camera.height);
  } else {
    BODYLOOM_CHECK(extent.width > 0 || input.camera.width > 0,
                   "track: the image size is not known; it is needed when the focal length is not");
  }
  CheckNumbers(input, options);
}

/// The camera the problem starts with. An unknown focal length starts at 0.9 of the longer side (58° field of view).
Camera StartCamera(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const ClipExtent extent = ExtentOf(input);
  const int width = input.camera.width > 0 ? input.camera.width : extent.width;
  const int height = input.camera.height > 0 ? input.camera.height : extent.height;
  if (options.camera_knowledge != CameraKnowledge::kKnown) {
    return MakePinhole(width, height, 0.9 * std::max(width, height));
  }
  Camera camera = input.camera;
  camera.width = width;
  camera.height = height;
  return camera;
}

/// Hypotheses are off by a share of the body, while a dense keypoint's σ is in pixels: where the image is large, all of
/// them would be outliers of the start. (The lifter's starts are near enough: with it this finds worse minima.)
void WidenDenseKernels(double stature, SequenceProblem* problem) {
  constexpr double kShareOfHeight = 0.008;  // the usual 4 σ of 1 px for a person 500 pixels high
  for (size_t t = 0; t < problem->frames.size(); ++t) {
    FrameData& frame = problem->frames[t];
    if (frame.dense == nullptr || frame.dense->empty()) continue;
    double sigma_px = 0;
    for (const DenseKeypoint& point : *frame.dense) sigma_px += point.sigma_px;
    sigma_px /= static_cast<double>(frame.dense->size());
    const double share_px = kShareOfHeight * PersonHeightPx(problem->layout, problem->states[t], stature);
    frame.dense_kernel = std::max(frame.dense_kernel, share_px / sigma_px);
  }
}

}  // namespace

bool TrackSequenceOptions::IsValid(std::string* why) const {
  if (solver != "ceres" && solver != "chain") {
    *why = "solver '" + solver + "' is unknown; expected 'ceres' or 'chain'";
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
  const InRange in_range(why);
  if (!in_range("lifter_weight", lifter_weight, 0, 1e6) ||
      !in_range("lifter_min_sigma_m", lifter_min_sigma_m, 1e-6, 1e3) ||
      !in_range("ground.contact_weight", ground.contact_weight, 0, 1e6) ||
      !in_range("ground.sigma_height_m", ground.sigma_height_m, 1e-4, 1e3) ||
      !in_range("ground.sigma_slide_m", ground.sigma_slide_m, 1e-4, 1e3) ||
      !in_range("rendered_uv.weight", rendered_uv.weight, 0, 1e6) ||
      !in_range("rendered_uv.max_points", rendered_uv.max_points, 1, 1e7) ||
      !in_range("rendered_uv.rounds", rendered_uv.rounds, 0, 100) ||
      !in_range("rendered_uv.max_iterations", rendered_uv.max_iterations, 1, 1000) ||
      !in_range("rendered_uv.min_cosine", rendered_uv.min_cosine, 1e-3, 1) ||
      !in_range("part_labels.silhouette_weight", part_labels.silhouette_weight, 0, 1e6) ||
      !in_range("part_labels.part_weight", part_labels.part_weight, 0, 1e6) ||
      !in_range("part_labels.sigma_share", part_labels.sigma_share, 1e-4, 1) ||
      !in_range("part_labels.start_kernel", part_labels.start_kernel, 0.1, 1e6) ||
      !in_range("part_labels.kernel", part_labels.kernel, 0.1, 1e6) ||
      !in_range("part_labels.rounds", part_labels.rounds, 1, 100) ||
      !in_range("part_labels.max_iterations", part_labels.max_iterations, 1, 1000)) {
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
  int impossible = 0;
  if (given.keypoints != nullptr) {
    repaired = *given.keypoints;
    DropUnusable(&repaired);
    impossible = DropImpossibleFrames(&repaired);
    summary.num_swaps_repaired = RepairSwaps(&repaired);
    input.keypoints = &repaired;
  }
  DenseSequence usable;
  if (given.dense != nullptr && HasUnusable(*given.dense)) {
    usable = *given.dense;
    DropUnusable(&usable);
    input.dense = &usable;
  }
  KeypointSequence from_dense;
  const KeypointSequence* joints = JointsToStartFrom(input, &from_dense);
  summary.solver = options.solver;
  summary.plan = PlanTrackSequence(input, options);
  if (impossible > 0) {
    summary.plan.push_back({"2D joints of impossible frames", false,
                            std::to_string(impossible) + " frames jump away from the person and back, or are flat"});
  }
  StageClock clock;
  const int threads = options.num_threads > 0 ? options.num_threads : std::max(1u, std::thread::hardware_concurrency());

  // Which landmarks and joints take part.
  const int num_betas = options.estimate_shape ? std::min(model.num_betas(), 10) : 0;
  const ObservedLandmarks landmarks = FindObservedLandmarks(model, input.keypoints, num_betas);
  const std::vector<int> active =
      FindActiveJoints(model, landmarks, input.dense != nullptr || input.part_labels != nullptr, options.skip_unneeded);
  const Camera camera = StartCamera(input, options);
  SequenceProblem problem;
  problem.layout = FrameLayout::Make(model, options.camera_knowledge, camera, active, num_betas);
  problem.timestamps = *ExtentOf(input).timestamps;
  const size_t T = problem.timestamps.size();
  problem.cut_before = joints != nullptr ? FindCuts(*joints) : std::vector<char>(T, 0);
  problem.betas = VectorXd::Zero(num_betas);
  problem.log_focal = problem.log_focal_prior = std::log(camera.fx);
  std::optional<MixturePrior> prior;
  if (input.prior != nullptr && input.prior->num_components() > 0) prior.emplace(*input.prior, model, active);
  const JointLimits limits = JointLimits::ForBody(model);

  // Starting poses.
  if (options.progress && !options.progress({"initialise", 0.0, 0.0})) {
    summary.status = SolveStatus::kStopped;
  }
  LiftedStart lifted;
  const InitialStates initial = FindInitialStates(input, joints, problem.layout, options, &lifted);
  if (initial.states.empty()) {
    summary.message =
        "no frame shows enough of the body to start from: a shoulder and a hip are needed, with some confidence";
    return result;
  }
  problem.states = initial.states;
  problem.betas = initial.betas;
  problem.shape_prior.mean = initial.betas;
  clock.Book("initialise");

  // What the lifter said stays as a term.
  LiftedLandmarks lifted_landmarks;
  if (!lifted.frames.empty()) lifted_landmarks = CompileLiftedLandmarks(model, num_betas);
  std::vector<LiftedPose> lifted_poses;
  for (const LiftedFrame& frame : lifted.frames) {
    lifted_poses.push_back(MakeLiftedPose(frame, lifted_landmarks, lifted.metres, options.lifter_min_sigma_m));
  }

  // Observations.
  VectorXd stature_gradient;
  const double stature = StatureOfMeanShape(model, num_betas, &stature_gradient);
  problem.frames.resize(T);
  for (size_t t = 0; t < T; ++t) {
    FrameData& frame = problem.frames[t];
    if (input.keypoints != nullptr) {
      const double height_px = PersonHeightPx(problem.layout, problem.states[t], stature);
      frame.landmarks = ObserveLandmarks(landmarks, *input.keypoints, static_cast<int>(t), height_px);
    }
    if (input.dense != nullptr) frame.dense = &input.dense->frames[t];
    if (prior) {
      frame.prior = &*prior;
      frame.prior_weight = options.prior_weight;
    }
    frame.limits = &limits;
    if (!lifted_poses.empty()) {
      frame.lifted = &lifted_poses[t];
      frame.lifted_weight = options.lifter_weight;
    }
    frame.upright_weight = options.upright_weight;
    frame.initial_rotations = problem.states[t].rotations;
    frame.initial_translation = problem.states[t].translation;
    summary.num_observations +=
        static_cast<int>(frame.landmarks.size()) + (frame.dense != nullptr ? static_cast<int>(frame.dense->size()) : 0);
  }
  // Detections of a frame and of its neighbours err together (COCO joints are not the body's, and detectors are off for
  // a third of a second at a time), so frames do not outvote the shape prior as independent measurements would.
  problem.shape_prior.weight = std::max(1.0, options.shape_prior_weight * static_cast<double>(T));
  GroundTerms ground(input, options, joints, lifted.frames, lifted_landmarks, &problem);
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
    solve_options.solver = options.solver == "chain" ? SequenceSolver::kChain : SequenceSolver::kCeres;
    if (options.skip_unneeded) {
      solve_options.early_dense = kTrackerEarlyDense;
      solve_options.rest_share = kTrackerRestShare;
      // Joints alone are evaluated as fast as skipped: 10 % slower with it on AIST++.
      if (input.dense != nullptr) solve_options.skip_settled = kTrackerSkipSettled;
    }
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
  const ImageTerms terms(input, options, problem.layout, threads);
  const std::vector<int> coarse_frames = FramesAtRate(problem, options.coarse_rate);
  const bool coarse_to_fine = coarse_frames.size() < T;
  const double final_pull = pulled ? 0.0 : options.initialiser_weight;
  const bool has_points = input.keypoints != nullptr || input.dense != nullptr;
  if (pulled || coarse_to_fine || terms.has_dense_rounds() || terms.has_part_labels()) {
    SequenceProblem coarse = SelectFrames(problem, coarse_frames);
    if (pulled) {
      if (lifted.frames.empty()) WidenDenseKernels(stature, &coarse);
      going = solve("fit near start", &coarse, options.start_pull, 8, 1e-3, options.max_iterations, 0.05, 0.3);
      for (FrameData& frame : coarse.frames) frame.dense_kernel = FrameData{}.dense_kernel;
    }
    if (going && has_points)
      going = solve("fit coarse", &coarse, final_pull, 4, 1e-4, options.max_iterations, 0.3, 0.45);
    // What the first answer says of the clip: how lively it is, and where its ground is.
    if (going && options.fit_smoothness) {
      problem.smoothness = coarse.smoothness = FitSmoothness(coarse, coarse.smoothness[0]);
    }
    const bool has_ground = going && ground.FindGround(coarse_frames, &coarse, &problem);
    if (going && has_points && (options.fit_smoothness || has_ground)) {
      going = solve("fit again", &coarse, final_pull, 4, 1e-4, options.max_iterations, 0.45, 0.5);
    }
    if (terms.has_part_labels()) {
      const PartLabelOptions& labels = options.part_labels;
      for (int round = 0; going && round < labels.rounds; ++round) {
        const double s = labels.rounds > 1 ? double(round) / (labels.rounds - 1) : 1.0;
        const double kernel = labels.start_kernel * std::pow(labels.kernel / labels.start_kernel, s);
        terms.StartPartLabelRound(coarse_frames, kernel, &coarse);
        going = solve("fit part labels", &coarse, final_pull, 4, 1e-4, labels.max_iterations, 0.5, 0.55);
      }
    }
    if (terms.has_dense_rounds()) {
      for (int round = 0; going && round < options.rendered_uv.rounds; ++round) {
        terms.StartDenseRound(coarse_frames, &coarse);
        going = solve("fit dense", &coarse, final_pull, 4, 1e-4, options.rendered_uv.max_iterations, 0.55, 0.6);
      }
    }
    SpreadFrames(coarse, coarse_frames, &problem);
  }
  // The coarse solve has settled what is slow to settle; between its frames a few steps are enough.
  std::vector<int> all_frames(T);
  std::iota(all_frames.begin(), all_frames.end(), 0);
  terms.StartPartLabelRound(all_frames, options.part_labels.kernel, &problem);
  terms.StartDenseRound(all_frames, &problem);
  const int fine_iterations = coarse_to_fine ? options.max_fine_iterations : options.max_iterations;
  if (going) solve("fit", &problem, final_pull, 4, 1e-4, fine_iterations, 0.6, 0.95);

  FillTrack(input, problem, landmarks, &result);
  terms.Summarise(problem, &summary);
  ground.Summarise(&summary);
  clock.Book("finish");
  if (options.estimate_uncertainty) {
    // On the coarse frames: neighbours' detection errors are not independent, and their joints' spread changes slowly.
    const RowMatrixXd sigma = JointPositionSigma(SelectFrames(problem, coarse_frames), threads);
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
  summary.seconds = clock.seconds();
  return result;
}

}  // namespace bodyloom
