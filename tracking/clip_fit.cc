// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/clip_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/camera_path.h"
#include "bodyloom/tracking/camera_scale.h"
#include "bodyloom/tracking/initialise/impossible_frames.h"
#include "bodyloom/tracking/initialise/initial_states.h"
#include "bodyloom/tracking/initialise/seen_feet.h"
#include "bodyloom/tracking/initialise/stature.h"
#include "bodyloom/tracking/initialise/swap_repair.h"
#include "bodyloom/tracking/input_checks.h"
#include "bodyloom/tracking/motion_level.h"
#include "bodyloom/tracking/moving_camera.h"
#include "bodyloom/tracking/observability.h"
#include "bodyloom/tracking/terms/own/own_terms.h"
#include "bodyloom/tracking/track_plan.h"
#include "bodyloom/tracking/track_result.h"
#include "bodyloom/tracking/track_world.h"
#include "bodyloom/tracking/uncertainty.h"

namespace bodyloom {
namespace {

using Eigen::VectorXd;

/// The camera the problem starts with.
Camera StartCamera(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const ClipExtent extent = ExtentOf(input);
  const int width = input.camera.width > 0 ? input.camera.width : extent.width;
  const int height = input.camera.height > 0 ? input.camera.height : extent.height;
  if (options.camera_knowledge != CameraKnowledge::kKnown) {
    const FocalPrior prior = input.focal_prior.value_or(FocalPrior::ForImage(width, height));
    return MakePinhole(width, height, std::exp(prior.log_mean));
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
    if (frame.dense.size() == 0) continue;
    double sigma_px = 0;
    for (const DenseKeypoint& point : *frame.dense.points) sigma_px += point.sigma_px;
    sigma_px /= static_cast<double>(frame.dense.size());
    const double share_px = kShareOfHeight * UprightHeightPx(problem->layout, StateInCamera(*problem, t), stature);
    frame.dense.kernel = std::max(frame.dense.kernel, share_px / sigma_px);
  }
}

}  // namespace

ClipFit::ClipFit(const TrackSequenceInput& given, const TrackSequenceOptions& options, TrackSequenceSummary* summary)
    : options_(options), summary_(*summary), threads_(ThreadsFor(options.num_threads)), input_(given) {
  CleanObservations();
  joints_ = JointsToStartFrom(input_, &joints_from_dense_);
  summary_.solver = ToString(options.solver);
  summary_.plan = PlanTrackSequence(input_, options);
  if (num_impossible_ > 0) {
    summary_.plan.push_back(
        {"2D joints of impossible frames", false,
         std::to_string(num_impossible_) + " frames jump away from the person and back, or are flat"});
  }
  clock_ = StageClock();
  SetUpProblem();
}

void ClipFit::CleanObservations() {
  if (input_.keypoints != nullptr) {
    keypoints_ = *input_.keypoints;
    DropUnusable(&keypoints_);
    num_impossible_ = DropImpossibleFrames(&keypoints_);
    summary_.num_swaps_repaired = RepairSwaps(&keypoints_);
    input_.keypoints = &keypoints_;
  }
  if (input_.dense != nullptr && HasUnusable(*input_.dense)) {
    dense_ = *input_.dense;
    DropUnusable(&dense_);
    input_.dense = &dense_;
  }
}

void ClipFit::SetUpProblem() {
  const BodyModel& model = *input_.body;
  const int num_betas = options_.estimate_shape ? std::min(model.num_betas(), 10) : 0;
  landmarks_ = FindObservedLandmarks(model, input_.keypoints, num_betas);
  const std::vector<int> active =
      FindActiveJoints(model, landmarks_, input_.dense != nullptr || input_.part_labels != nullptr,
                       options_.skip_unneeded, options_.own_terms);
  const Camera camera = StartCamera(input_, options_);
  problem_.layout = FrameLayout::Make(model, options_.camera_knowledge, camera, active, num_betas);
  problem_.timestamps = *ExtentOf(input_).timestamps;
  problem_.cut_before = joints_ != nullptr ? FindCuts(*joints_) : std::vector<char>(num_frames(), 0);
  problem_.betas = VectorXd::Zero(num_betas);
  problem_.log_focal = problem_.log_focal_prior = std::log(camera.fx);
  problem_.log_focal_sigma = input_.focal_prior.value_or(FocalPrior()).log_sigma;
  if (input_.prior != nullptr && input_.prior->num_components() > 0) prior_.emplace(*input_.prior, model, active);
  limits_ = JointLimits::ForBody(model);
  stature_m_ = AssumedStature(input_);
  problem_.shape_prior.height_m = summary_.stature_m = input_.stature_m;
}

bool ClipFit::FindStart() {
  if (options_.progress && !options_.progress({"initialise", 0.0, 0.0})) summary_.status = SolveStatus::kStopped;
  const InitialStates initial = FindInitialStates(input_, joints_, problem_.layout, options_, &lifted_);
  if (initial.states.empty()) {
    summary_.message =
        "no frame shows enough of the body to start from: a shoulder and a hip are needed, with some confidence";
    return false;
  }
  problem_.states = initial.states;
  problem_.betas = initial.betas;
  problem_.shape_prior.mean = initial.betas;
  clock_.Book("initialise");
  if (!lifted_.frames.empty()) {
    lifted_landmarks_ = CompileLiftedLandmarks(*input_.body, problem_.layout.num_betas);
  }
  if (input_.initialiser != nullptr) return true;
  // What the lifter predicted stays as a term.
  for (const LiftedFrame& frame : lifted_.frames) {
    lifted_poses_.push_back(MakeLiftedPose(frame, lifted_landmarks_, lifted_.metres, options_.lifter_min_sigma_m));
  }
  return true;
}

void ClipFit::FollowCamera() {
  if (input_.camera_from_scene == nullptr) return;
  camera_path_ = ScaledPath(*input_.camera_from_scene, input_.camera_scale_m);
  summary_.camera_path.moves = true;
  summary_.camera_path.scale_m = input_.camera_scale_m;
  summary_.camera_path.estimated = seeks_camera_scale();
  for (size_t t = 0; t < num_frames(); ++t) {
    problem_.frames[t].camera_from_scene = &camera_path_[t];
    problem_.states[t] =
        StateInCamera(problem_.layout, Inverse(camera_path_[t]), problem_.betas, std::move(problem_.states[t]));
  }
}

void ClipFit::Observe() {
  const size_t T = num_frames();
  const std::array<int, 2> knees = FindKnees(*input_.body);
  problem_.frames.resize(T);
  for (size_t t = 0; t < T; ++t) {
    FrameData& frame = problem_.frames[t];
    if (input_.keypoints != nullptr) {
      const double height_px = UprightHeightPx(problem_.layout, problem_.states[t], stature_m_);
      frame.landmarks.seen = ObserveLandmarks(landmarks_, *input_.keypoints, static_cast<int>(t), height_px);
    }
    if (input_.dense != nullptr) frame.dense.points = &input_.dense->frames[t];
    if (prior_) {
      frame.prior.mixture = &*prior_;
      frame.prior.weight = options_.prior_weight;
    }
    frame.limits.limits = &limits_;
    if (!lifted_poses_.empty()) {
      frame.lifted.pose = &lifted_poses_[t];
      frame.lifted.weight = options_.lifter_weight;
    }
    frame.upright.weight = options_.upright_weight;
    frame.straight_knees = {knees, options_.straight_knees_weight};
    if (input_.initialiser == nullptr || input_.initialiser->HasPose(static_cast<int>(t))) {
      frame.initialiser.rotations = problem_.states[t].rotations;
      frame.initialiser.translation = problem_.states[t].translation;
    }
    summary_.num_observations += static_cast<int>(frame.landmarks.seen.size() + frame.dense.size());
  }
  FollowCamera();
  AddOwnTerms(options_.own_terms, &problem_);
  problem_.velocity_weight = options_.velocity_weight;
  // Detections of a frame and of its neighbours err together (COCO joints are not the body's, and detectors are off for
  // a third of a second at a time), so frames do not outvote the shape prior as independent measurements would.
  problem_.shape_prior.weight = std::max(1.0, options_.shape_prior_weight * static_cast<double>(T));
  ground_.emplace(input_, options_, joints_, lifted_.frames, lifted_landmarks_, &problem_);
  summary_.num_parameters = static_cast<int>(T) * problem_.layout.num_frame_columns() + problem_.layout.num_columns -
                            problem_.layout.beta_column;
  dense_rounds_.emplace(input_, options_, problem_.layout, threads_);
  part_label_rounds_.emplace(input_, options_, problem_.layout, threads_);
  coarse_frames_ = FramesAtRate(problem_, options_.coarse_rate);
  stages_ = StagesFor(input_, options_, coarse_frames_.size() < T);
  runner_.emplace(input_, options_, threads_, &clock_, &summary_);
}

void ClipFit::FitCoarseFrames() {
  const bool from_guess = input_.initialiser == nullptr;
  const bool learns =
      !lifted_.frames.empty() || dense_rounds_->any() || part_label_rounds_->any() || seeks_camera_scale();
  if (!from_guess && coarse_frames_.size() == num_frames() && !learns) return;
  SequenceProblem coarse = SelectFrames(problem_, coarse_frames_);
  if (from_guess) FitNearStart(&coarse);
  FitCameraScale(&coarse);
  if (has_points()) runner_->Run(stages_.coarse, &coarse);
  SettleFocalLength(&coarse);
  FitCameraScale(&coarse);
  LearnFromFirstAnswer(&coarse);
  FitPartLabels(&coarse);
  FitDense(&coarse);
  SpreadFrames(coarse, coarse_frames_, &problem_);
}

void ClipFit::FitNearStart(SequenceProblem* coarse) {
  if (lifted_.frames.empty()) WidenDenseKernels(stature_m_, coarse);
  runner_->Run(stages_.near_start, coarse);
  for (FrameData& frame : coarse->frames) frame.dense.kernel = DenseOfFrame{}.kernel;
}

void ClipFit::LearnFromFirstAnswer(SequenceProblem* coarse) {
  if (!runner_->going()) return;
  if (options_.fit_smoothness) {
    problem_.smoothness = coarse->smoothness = FitSmoothness(*coarse, coarse->smoothness[0]);
  }
  const bool has_ground = ground_->FindGround(coarse_frames_, coarse, &problem_);
  if (has_points() && (options_.fit_smoothness || has_ground || settled_focal_)) runner_->Run(stages_.again, coarse);
}

void ClipFit::FitCameraScale(SequenceProblem* coarse) {
  if (!seeks_camera_scale() || !runner_->going()) return;
  CameraPathSummary& summary = summary_.camera_path;
  if (lifted_.frames.empty() || joints_ == nullptr) {
    summary.why = "the lifter says which feet stand, and it does not run";
    return;
  }
  std::vector<std::array<FootPlace, 2>> feet =
      SeenFeet(*coarse, coarse_frames_, lifted_.frames, lifted_landmarks_, *joints_);
  std::vector<CameraPose> unit_path;
  for (size_t i = 0; i < feet.size(); ++i) {
    unit_path.push_back((*input_.camera_from_scene)[coarse_frames_[i]]);
    for (FootPlace& foot : feet[i]) foot.ankle_m = MovedPoint(camera_path_[coarse_frames_[i]], foot.ankle_m);
  }
  const CameraScale scale = EstimateCameraScale(feet, coarse->timestamps, coarse->cut_before, unit_path);
  summary.why = scale.why;
  summary.scale_m = scale.found ? scale.scale_m : 0;
  summary.sigma_m = scale.found ? scale.sigma_m : 0;
  ScaleCameraPath(summary.scale_m, coarse);
}

void ClipFit::ScaleCameraPath(double scale_m, SequenceProblem* coarse) {
  const std::vector<CameraPose> before = camera_path_, after = ScaledPath(*input_.camera_from_scene, scale_m);
  const auto move = [&](int t, const Eigen::VectorXd& betas, FrameState* state) {
    *state = StateInCamera(problem_.layout, Compose(Inverse(after[t]), before[t]), betas, std::move(*state));
  };
  for (size_t i = 0; i < coarse_frames_.size(); ++i) move(coarse_frames_[i], coarse->betas, &coarse->states[i]);
  for (size_t t = 0; t < num_frames(); ++t) move(static_cast<int>(t), problem_.betas, &problem_.states[t]);
  std::copy(after.begin(), after.end(), camera_path_.begin());  // frames point into it
}

void ClipFit::SettleFocalLength(SequenceProblem* coarse) {
  constexpr double kHeldLogSigma = 1e-4;
  const bool joints_alone = !lifted_.frames.empty() && input_.dense == nullptr;
  if (problem_.layout.focal_column < 0 || !joints_alone || !runner_->going()) return;
  const FocalFit fit{coarse->log_focal, FocalLogSigmaOf(*coarse, threads_)};
  const FocalFit joined =
      JoinFocalFits({&fit, 1}, {.log_mean = problem_.log_focal_prior, .log_sigma = problem_.log_focal_sigma});
  const double farther = std::exp(joined.log_px - fit.log_px);
  const double pelvis_z = input_.body->RestJoints(coarse->betas)(0, 2);
  for (size_t i = 0; i < coarse->states.size(); ++i) {
    FrameState seen = StateInCamera(*coarse, i);
    seen.translation.z() = farther * (pelvis_z + seen.translation.z()) - pelvis_z;
    const CameraPose* camera = coarse->frames[i].camera_from_scene;
    coarse->states[i] = camera == nullptr
                            ? std::move(seen)
                            : StateInCamera(problem_.layout, Inverse(*camera), coarse->betas, std::move(seen));
  }
  for (SequenceProblem* problem : {coarse, &problem_}) {
    problem->log_focal = problem->log_focal_prior = joined.log_px;
    problem->log_focal_sigma = kHeldLogSigma;
  }
  summary_.focal_fit = fit;
  settled_focal_ = joined;
}

void ClipFit::FitPartLabels(SequenceProblem* coarse) {
  if (!part_label_rounds_->any()) return;
  const PartLabelOptions& labels = options_.part_labels;
  for (int round = 0; runner_->going() && round < labels.rounds; ++round) {
    const double s = labels.rounds > 1 ? double(round) / (labels.rounds - 1) : 1.0;
    const double kernel = labels.start_kernel * std::pow(labels.kernel / labels.start_kernel, s);
    part_label_rounds_->Start(coarse_frames_, kernel, coarse);
    runner_->Run(stages_.part_labels, coarse);
  }
}

void ClipFit::FitDense(SequenceProblem* coarse) {
  if (!dense_rounds_->any()) return;
  for (int round = 0; runner_->going() && round < options_.rendered_uv.rounds; ++round) {
    dense_rounds_->Start(coarse_frames_, coarse);
    runner_->Run(stages_.dense, coarse);
  }
}

void ClipFit::FitAllFrames() {
  std::vector<int> all(num_frames());
  std::iota(all.begin(), all.end(), 0);
  part_label_rounds_->Start(all, options_.part_labels.kernel, &problem_);
  dense_rounds_->Start(all, &problem_);
  runner_->Run(stages_.all, &problem_);
}

void ClipFit::Finish(TrackSequenceResult* result) {
  FillTrack(input_, problem_, landmarks_, result);
  SummariseImageTerms(problem_, dense_rounds_->has_rendered_uv(), part_label_rounds_->any(), &summary_);
  summary_.own_terms = SummariseOwnTerms(options_.own_terms, problem_);
  ground_->Summarise(problem_, &summary_);
  result->track.world = WorldOfGround(summary_.ground, result->track.joints);
  clock_.Book("finish");
  summary_.focal_log_sigma = problem_.layout.focal_column < 0 ? 0 : std::numeric_limits<double>::quiet_NaN();
  if (options_.estimate_uncertainty) {
    FillJointSigma(&result->track);
    clock_.Book("uncertainty");
  }
  summary_.seconds = clock_.seconds();
}

void ClipFit::FillJointSigma(Track* track) {
  // On the coarse frames: neighbours' detection errors are not independent, and their joints' spread changes slowly.
  const PositionSigma sigma =
      PositionSigmaOf(SelectFrames(problem_, coarse_frames_), threads_, &summary_.focal_log_sigma);
  const auto distance = [&](size_t i, size_t t) {
    return std::abs(problem_.timestamps[coarse_frames_[i]] - problem_.timestamps[t]);
  };
  for (size_t i = 0, t = 0; t < num_frames(); ++t) {
    while (i + 1 < coarse_frames_.size() && distance(i + 1, t) <= distance(i, t)) ++i;
    track->joint_sigma.row(t) = sigma.joints.row(i);
    track->root_sigma[t] = sigma.hips[i];
  }
  if (!settled_focal_) return;
  summary_.focal_log_sigma = settled_focal_->log_sigma;  // in the equations it is held
  AddFocalSpread(settled_focal_->log_sigma, track);
}

}  // namespace bodyloom
