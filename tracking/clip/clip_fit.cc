// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/clip_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tracking/clip/camera_scale.h"
#include "tracking/clip/clip_views.h"
#include "tracking/clip/term_kinds.h"
#include "tracking/clip/track_plan.h"
#include "tracking/clip/track_result.h"
#include "tracking/clip/turn_to_vertical.h"
#include "tracking/clip/uncertainty.h"
#include "tracking/hands/fit_hands.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/outlier_frames.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/problem/input_checks.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/stature.h"
#include "tracking/room/flights.h"
#include "tracking/room/shared_scene.h"
#include "tracking/solvers/chain/chain_problem.h"
#include "tracking/solvers/residuals/acceleration_cost.h"
#include "tracking/solvers/solve_sequence.h"
#include "tracking/solvers/term_costs.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/ground_contact/clip_ground.h"
#include "tracking/terms/observability.h"
#include "tracking/terms/surface_contact/clip_contacts.h"

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

/// σ of adults' stature, metres: of a person whose size cameras at known places measure.
constexpr double kStatureSpreadM = 0.1;

/// Frames of a long clip whose uncertainty is computed at once, when everything else of the clip is there, too.
constexpr int kSigmaFramesAtOnce = 500;

/// Above the floor, of the lifter's points of a foot that stands flat, metres.
constexpr double kToeHeight = 0.012, kHeelHeight = 0.027;

/// Widens the kernels of dense keypoints for starts from hypotheses. Errors of hypotheses are proportional to the body,
/// while a dense keypoint's σ is in pixels: in a large image all keypoints would be outliers at the start. (Starts from
/// the lifter are near enough; for them wider kernels lead to worse minima.)
void WidenDenseKernels(double stature, SequenceProblem* problem) {
  constexpr double kShareOfHeight = 0.008;  // the usual 4 σ of 1 px for a person 500 pixels high
  for (size_t t = 0; t < problem->frames.size(); ++t) {
    auto* dense = problem->frames[t].terms.Find<DenseTerm>();
    if (dense == nullptr || dense->size() == 0) continue;
    double sigma_px = 0;
    for (const DenseKeypoint& point : *dense->points) sigma_px += point.sigma_px;
    sigma_px /= static_cast<double>(dense->size());
    const double share_px = kShareOfHeight * UprightHeightPx(problem->layout, StateInCamera(*problem, t), stature);
    dense->kernel = std::max(dense->kernel, share_px / sigma_px);
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
    const CleanedKeypoints cleaned = CleanKeypoints(&keypoints_);
    num_impossible_ = cleaned.impossible_frames;
    summary_.num_swaps_repaired = cleaned.swaps;
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
                       options_.skip_unneeded, SeeksContacts(input_, options_), options_.user_terms);
  const Camera camera = StartCamera(input_, options_);
  problem_.layout = FrameLayout::Make(model, options_.camera_knowledge, camera, active, num_betas);
  problem_.timestamps = *ExtentOf(input_).timestamps;
  problem_.cut_before = joints_ != nullptr ? FindCuts(*joints_) : std::vector<char>(num_frames(), 0);
  problem_.betas = VectorXd::Zero(num_betas);
  problem_.log_focal = problem_.log_focal_prior = std::log(camera.fx);
  problem_.log_focal_sigma = input_.focal_prior.value_or(FocalPrior()).log_sigma;
  if (input_.start != nullptr && input_.start->focal_px > 0 && problem_.layout.focal_column >= 0) {
    problem_.log_focal = std::log(input_.start->focal_px);
  }
  AddViews(input_, &problem_);
  stature_m_ = AssumedStature(input_);
  problem_.shape_prior.height_m = summary_.stature_m = input_.stature_m;
  const bool measured = input_.views != nullptr && std::any_of(input_.views->begin(), input_.views->end(),
                                                               [](const ViewInput& view) { return view.pose_known; });
  if (measured && input_.stature_m == 0) problem_.shape_prior.height_sigma_m = kStatureSpreadM;
}

bool ClipFit::FindStart() {
  if (options_.progress && !options_.progress({"initialise", 0.0, 0.0})) summary_.status = SolveStatus::kStopped;
  InitialStates initial = FindInitialStates(input_, joints_, problem_.layout, options_, &lifted_);
  if (initial.states.empty()) {
    summary_.message =
        "no frame shows enough of the body to start from: a shoulder and a hip are needed, with some confidence";
    return false;
  }
  if (options_.ground.use_up) {
    const double log_sigma = problem_.layout.focal_column >= 0 ? problem_.log_focal_sigma : 0;
    TurnToVertical(input_, {std::exp(problem_.log_focal), log_sigma}, problem_.cut_before, &lifted_, &initial.states);
  }
  problem_.states = std::move(initial.states);
  problem_.betas = initial.betas;
  if (input_.start != nullptr) StartFrom(*input_.start);
  views_ = ObserveViews(input_, problem_.layout, options_);
  if (options_.ground.use_up) TurnViewsToVertical(input_, problem_.layout, &views_);
  problem_.shape_prior.mean = initial.betas;
  for (LiftedFrame& frame : lifted_.frames) frame.limbs = {};  // they are half of it
  clock_.Record("initialise");
  if (!lifted_.frames.empty()) {
    lifted_landmarks_ = CompileLiftedLandmarks(*input_.body, problem_.layout.num_betas);
  }
  return true;
}

void ClipFit::StartFrom(const TrackStart& start) {
  problem_.states = start.states;
  const Eigen::Index given = std::min<Eigen::Index>(start.betas.size(), problem_.layout.num_betas);
  problem_.betas.head(given) = start.betas.head(given);
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
  problem_.frames.resize(T);
  const ClipTermInput clip{.input = input_,
                           .options = options_,
                           .layout = problem_.layout,
                           .landmarks = landmarks_,
                           .joints = joints_,
                           .lifted = lifted_,
                           .lifted_landmarks = lifted_landmarks_,
                           .views = views_,
                           .stature_m = stature_m_,
                           .num_threads = threads_};
  for (const TermKind& kind : TermKinds()) {
    std::unique_ptr<ClipTerm> term = kind.make(clip);
    if (term == nullptr) continue;
    term->Observe(&problem_);
    terms_.push_back(std::move(term));
  }
  for (const FrameData& frame : problem_.frames) {
    summary_.num_observations +=
        static_cast<int>(frame.Get<LandmarkTerm>().seen.size() + frame.Get<DenseTerm>().size());
  }
  if (const int rows = NumFarRows(problem_); rows > ChainProblem::kMaxFarRows) {
    summary_.plan.push_back(
        {"chain", false,
         Concatenate("terms couple frames apart from each other in ", rows, " residuals: Ceres solves every stage")});
  }
  FollowCamera();
  problem_.velocity_weight = options_.velocity_weight;
  // Detection errors of neighbouring frames are correlated (COCO joints are not the body's, and errors of detectors
  // last for a third of a second), so frames must not outweigh the shape prior as independent measurements would.
  problem_.shape_prior.weight = std::max(1.0, options_.shape_prior_weight * static_cast<double>(T));
  for (const auto& term : terms_) term->BeginFit(&problem_);
  summary_.num_parameters = static_cast<int>(T) * problem_.layout.num_frame_columns() + problem_.layout.num_columns -
                            problem_.layout.beta_column;
  std::vector<char> anchors;
  for (const auto& term : terms_) {
    if (anchors.empty()) anchors = term->SparseFrames();
  }
  coarse_frames_ = FramesAtRate(problem_, options_.coarse_rate, anchors);
  stages_ = StagesFor(input_, options_, coarse_frames_.size() < T);
  runner_.emplace(input_, options_, threads_, &clock_, &summary_);
}

void ClipFit::FitCoarseFrames() {
  const bool from_guess = input_.initialiser == nullptr;
  const bool has_rounds =
      std::any_of(terms_.begin(), terms_.end(), [](const auto& term) { return term->rounds().count > 0; });
  const bool learns = !lifted_.frames.empty() || has_rounds || seeks_camera_scale();
  if (!from_guess && coarse_frames_.size() == num_frames() && !learns) return;
  SequenceProblem coarse = SelectFrames(problem_, coarse_frames_);
  if (from_guess) FitNearStart(&coarse);
  FitCameraScale(&coarse);
  if (has_points()) RunCoarse(stages_.coarse, &coarse);
  SettleFocalLength(&coarse);
  FitCameraScale(&coarse);
  LearnFromFirstAnswer(&coarse);
  FitRounds(&coarse);
  SpreadFrames(coarse, coarse_frames_, &problem_);
}

void ClipFit::RunCoarse(Stage stage, SequenceProblem* coarse) {
  if (runner_->ok() && runner_->InWindows(*coarse)) {
    Stage on_sample = stage;
    on_sample.to = stage.from = std::midpoint(stage.from, stage.to);
    on_sample.of_sample = true;
    SequenceSample sample(*coarse, kSampleFrames);
    runner_->Run(on_sample, &sample.part);
    TakeSample(sample, coarse);
    stage.in_windows = true;
  }
  runner_->Run(stage, coarse);
}

void ClipFit::TakeSample(const SequenceSample& sample, SequenceProblem* coarse) const {
  if (problem_.layout.focal_column >= 0) {
    const double farther = std::exp(sample.part.log_focal - coarse->log_focal);
    for (size_t i = 0; i < coarse->states.size(); ++i) ScaleDepth(farther, i, coarse);
  }
  static_cast<SharedValues&>(*coarse) = sample.part;
  for (size_t i = 0; i < sample.frames.size(); ++i) coarse->states[sample.frames[i]] = sample.part.states[i];
}

void ClipFit::ScaleDepth(double factor, size_t i, SequenceProblem* problem) const {
  const double pelvis_z = input_.body->RestJoints(problem->betas)(0, 2);
  FrameState seen = StateInCamera(*problem, i);
  seen.translation.z() = factor * (pelvis_z + seen.translation.z()) - pelvis_z;
  const CameraPose* camera = problem->frames[i].camera_from_scene;
  problem->states[i] = camera == nullptr
                           ? std::move(seen)
                           : StateInCamera(problem_.layout, Inverse(*camera), problem->betas, std::move(seen));
}

void ClipFit::FitNearStart(SequenceProblem* coarse) {
  if (lifted_.frames.empty()) WidenDenseKernels(stature_m_, coarse);
  RunCoarse(stages_.near_start, coarse);
  for (FrameData& frame : coarse->frames) {
    if (auto* dense = frame.terms.Find<DenseTerm>(); dense != nullptr) dense->kernel = DenseTerm().kernel;
  }
}

void ClipFit::LearnFromFirstAnswer(SequenceProblem* coarse) {
  if (!runner_->ok()) return;
  if (options_.fit_smoothness) {
    problem_.smoothness = coarse->smoothness = FitSmoothness(*coarse, coarse->smoothness[0]);
  }
  bool learned = false;
  for (const auto& term : terms_) learned = term->LearnFrom(coarse_frames_, coarse, &problem_) || learned;
  if (has_points() && (options_.fit_smoothness || learned || settled_focal_)) RunCoarse(stages_.again, coarse);
}

void ClipFit::FitCameraScale(SequenceProblem* coarse) {
  if (!seeks_camera_scale() || !runner_->ok()) return;
  CameraPathSummary& summary = summary_.camera_path;
  if (lifted_.frames.empty() || joints_ == nullptr) {
    summary.why = "the lifter says which feet stand, and it does not run";
    return;
  }
  std::vector<std::vector<std::array<FootPlace, 2>>> points;
  std::vector<double> heights_m;
  for (const auto& [left_point, height_m] :
       {std::pair{int{kLifterLeftAnkle}, kAnkleHeight}, std::pair{int{kLifterLeftBigToe}, kToeHeight},
        std::pair{int{kLifterLeftHeel}, kHeelHeight}}) {
    if (!lifted_landmarks_.known[left_point]) continue;
    heights_m.push_back(height_m);
    points.push_back(ObservedFeet(*coarse, coarse_frames_, lifted_.frames, lifted_landmarks_, *joints_, left_point));
  }
  std::vector<CameraPose> unit_path;
  for (size_t i = 0; i < coarse_frames_.size(); ++i) {
    unit_path.push_back((*input_.camera_from_scene)[coarse_frames_[i]]);
    for (auto& feet : points) {
      for (FootPlace& foot : feet[i]) foot.ankle_m = MovedPoint(camera_path_[coarse_frames_[i]], foot.ankle_m);
    }
  }
  CameraScale scale = EstimateCameraScale(points, coarse->timestamps, coarse->cut_before, unit_path);
  const CameraScale by_floor = ScaleByFloor(points, heights_m, coarse->timestamps, unit_path, FloorOfPoints());
  if (!scale.found && !by_floor.found) {
    std::vector<Eigen::Vector3d> pelvises;
    const Eigen::Vector3d at_rest = input_.body->RestJoints(coarse->betas).row(0).transpose();
    for (size_t i = 0; i < coarse_frames_.size(); ++i) {
      pelvises.push_back(
          MovedPoint(camera_path_[coarse_frames_[i]], at_rest + coarse->layout.BodyPlace(coarse->states[i])));
    }
    const CameraScale by_place = ScaleByPlace(pelvises, coarse->timestamps, coarse->cut_before, unit_path);
    if (by_place.found) scale = by_place;
  }
  scale = JoinScales(scale, by_floor);
  summary.why = scale.why;
  summary.scale_m = scale.found ? scale.scale_m : 0;
  summary.sigma_m = scale.found ? scale.sigma_m : 0;
  ScaleCameraPath(summary.scale_m, coarse);
}

const PointsFloor& ClipFit::FloorOfPoints() {
  if (!points_floor_) {
    points_floor_.emplace();
    if (input_.background_points != nullptr) {
      if (const UpEstimate up = UpInScene(lifted_.frames, problem_.frames); up.found) {
        points_floor_ = FindPointsFloor(*input_.background_points, up.up);
      }
    }
  }
  return *points_floor_;
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
  const bool joints_alone = !lifted_.frames.empty() && input_.dense == nullptr && problem_.views.empty();
  if (problem_.layout.focal_column < 0 || !joints_alone || !runner_->ok()) return;
  FocalFit fit{.log_px = coarse->log_focal};
  if (runner_->InWindows(*coarse)) {
    const SequenceSample sample(*coarse, kSampleFrames);
    fit.log_sigma = std::sqrt(sample.share) * FocalLogSigmaOf(sample.part, threads_);
  } else {
    fit.log_sigma = FocalLogSigmaOf(*coarse, threads_);
  }
  const FocalFit joined =
      JoinFocalFits({&fit, 1}, {.log_mean = problem_.log_focal_prior, .log_sigma = problem_.log_focal_sigma});
  const double farther = std::exp(joined.log_px - fit.log_px);
  for (size_t i = 0; i < coarse->states.size(); ++i) ScaleDepth(farther, i, coarse);
  for (SequenceProblem* problem : {coarse, &problem_}) {
    problem->log_focal = problem->log_focal_prior = joined.log_px;
    problem->log_focal_sigma = kHeldLogSigma;
  }
  summary_.focal_fit = fit;
  settled_focal_ = joined;
}

void ClipFit::FitRounds(SequenceProblem* coarse) {
  // Terms that name the same stage share its solves.
  std::vector<std::vector<ClipTerm*>> shared;
  for (auto term = terms_.rbegin(); term != terms_.rend(); ++term) {
    const ClipTerm::Rounds rounds = (*term)->rounds();
    if (rounds.count == 0) continue;
    const auto same = std::find_if(shared.begin(), shared.end(), [&](const std::vector<ClipTerm*>& terms) {
      return std::string_view(terms.front()->rounds().stage) == rounds.stage;
    });
    if (same != shared.end()) {
      same->push_back(term->get());
    } else {
      shared.push_back({term->get()});
    }
  }
  if (shared.empty()) return;
  const bool in_windows = runner_->InWindows(*coarse);
  for (const auto& term : terms_) term->BeginRounds(coarse_frames_, in_windows);
  const double from = stages_.round.from, to = stages_.round.to;
  if (!in_windows) {
    RunRounds(shared, coarse_frames_, from, to, {}, coarse);
    return;
  }
  const auto windows = WindowsOf(static_cast<int>(coarse->states.size()), kChainFramesAtOnce.window);
  const double share = (to - from) / static_cast<double>(windows.size() + 1);
  const auto in_clip = [&](std::vector<int> frames) {
    for (int& t : frames) t = coarse_frames_[t];
    return frames;
  };
  {
    SequenceSample sample(*coarse, kSampleFrames);
    RunRounds(shared, in_clip(sample.frames), from, from + share, {}, &sample.part);
    TakeSample(sample, coarse);
  }
  for (size_t w = 0; runner_->ok() && w < windows.size(); ++w) {
    SequenceWindow window(*coarse, windows[w].first, windows[w].second);
    const double begin = from + share * static_cast<double>(w + 1);
    RunRounds(shared, in_clip(window.frames), begin, begin + share, window.held, &window.part);
    window.PutInto(coarse);
  }
}

void ClipFit::RunRounds(const std::vector<std::vector<ClipTerm*>>& shared, const std::vector<int>& frames, double from,
                        double to, const std::vector<char>& held, SequenceProblem* part) {
  int total = 0;
  for (const auto& terms : shared) total += terms.front()->rounds().count;
  const double share = (to - from) / total;  // of the whole progress
  Stage stage = stages_.round;
  stage.from = from;
  // Labels align the body with its outline before dense keypoints are matched to the visible surface.
  for (const auto& terms : shared) {
    const ClipTerm::Rounds rounds = terms.front()->rounds();
    stage.name = rounds.stage;
    stage.max_iterations = rounds.max_iterations;
    for (int round = 0; runner_->ok() && round < rounds.count; ++round) {
      stage.to = stage.from + share;
      for (ClipTerm* term : terms) term->StartRound(round, frames, part);
      runner_->Run(stage, part, held);
      stage.from = stage.to;
    }
  }
}

void ClipFit::FitAllFrames() {
  std::vector<int> all(num_frames());
  std::iota(all.begin(), all.end(), 0);
  for (auto term = terms_.rbegin(); term != terms_.rend(); ++term) {
    const int count = (*term)->rounds().count;
    if ((*term)->rounds().stage[0] != '\0') (*term)->StartRound(std::max(0, count - 1), all, &problem_);
  }
  runner_->Run(stages_.all, &problem_);
}

void ClipFit::FinishWithCeres() {
  if (options_.solver != SequenceSolver::kChainThenCeres) return;
  runner_->Run(stages_.finish, SequenceSolver::kCeres, &problem_);
}

void ClipFit::Finish(TrackSequenceResult* result) {
  FillTrack(input_, problem_, landmarks_, result);
  LoseUnseenFrames(problem_, result);
  FrameResiduals residuals;
  SummariseCosts(problem_, threads_, &residuals, &summary_);
  if (options_.solver == SequenceSolver::kChain && num_frames() > static_cast<size_t>(kChainFramesAtOnce.whole)) {
    summary_.final_cost = 0;  // that of the windows counts the frames that two of them share twice
    for (const TermCost& term : summary_.costs) summary_.final_cost += term.cost;
  }
  SummariseImageTerms(problem_, residuals, &summary_);
  for (const auto& term : terms_) term->Summarise(problem_, &summary_);
  result->track.world = WorldOfGround(summary_.ground, result->track.joints);
  result->track.level_m = LevelsOverGround(problem_.frames, summary_.ground);
  summary_.flights = StatureFromFlights(problem_, result->track, threads_);
  clock_.Record("finish");
  summary_.focal_log_sigma = problem_.layout.focal_column < 0 ? 0 : std::numeric_limits<double>::quiet_NaN();
  if (options_.estimate_uncertainty) {
    FillJointSigma(&result->track);
    clock_.Record("uncertainty");
  }
  if (input_.hands_and_face != nullptr) {
    FitHandsAndHead(input_, threads_, result);
    clock_.Record("hands and head");
  }
  summary_.seconds = clock_.seconds();
}

void ClipFit::FillJointSigma(Track* track) {
  // On the coarse frames: neighbours' detection errors are not independent, and their joints' spread changes slowly.
  SequenceProblem coarse = SelectFrames(problem_, coarse_frames_);
  const bool several = !problem_.views.empty();
  if (several) LeaveGround(&coarse);
  double* const focal_log_sigma = &summary_.focal_log_sigma;
  const PositionSigma sigma = runner_->InWindows(coarse)
                                  ? PositionSigmaInWindows(coarse, kSigmaFramesAtOnce, threads_, focal_log_sigma)
                                  : PositionSigmaOf(std::move(coarse), threads_, focal_log_sigma);
  SetViewSigma(problem_.layout, sigma.shared.diagonal().cwiseSqrt(), &summary_);
  if (several && problem_.layout.focal_column >= 0) {
    summary_.focal_log_sigma = std::min(kViewSigmaFactor * summary_.focal_log_sigma, problem_.log_focal_sigma);
  }
  const auto distance = [&](size_t i, size_t t) {
    return std::abs(problem_.timestamps[coarse_frames_[i]] - problem_.timestamps[t]);
  };
  for (size_t i = 0, t = 0; t < num_frames(); ++t) {
    while (i + 1 < coarse_frames_.size() && distance(i + 1, t) <= distance(i, t)) ++i;
    if (track->frame_status[t] == FrameStatus::kLost) continue;
    track->joint_sigma.row(t) = sigma.joints.row(i);
    track->root_sigma[t] = sigma.hips[i];
  }
  if (several) AddFocalSpread(summary_.focal_log_sigma, track);
  if (!settled_focal_) return;
  summary_.focal_log_sigma = settled_focal_->log_sigma;  // the normal equations hold it
  AddFocalSpread(settled_focal_->log_sigma, track);
}

std::vector<double> TipAccelerationRms(const SequenceProblem& problem, int shot) {
  const std::vector<int> shots = ShotOfFrames(problem.cut_before);
  std::vector<double> rms = JointLevers(*problem.layout.model);
  std::vector<char> active(rms.size(), 0);
  for (const int j : problem.layout.active_joints) active[j] = 1;
  const auto [begin, end] = std::equal_range(shots.begin(), shots.end(), shot);
  const auto first = static_cast<size_t>(begin - shots.begin()), last = static_cast<size_t>(end - shots.begin());
  for (size_t j = 0; j < rms.size(); ++j) {
    double squares = 0;
    int64_t count = 0;
    for (size_t t = first + 2; active[j] != 0 && t < last; ++t) {
      const AccelerationFactors f = AccelerationFactors::Of(problem.timestamps[t - 1] - problem.timestamps[t - 2],
                                                            problem.timestamps[t] - problem.timestamps[t - 1]);
      const Eigen::Matrix3d &a = problem.states[t - 2].rotations[j], &b = problem.states[t - 1].rotations[j],
                            &c = problem.states[t].rotations[j];
      const double squared = (rms[j] * (f.later * AxisAngleFromRotation(b.transpose() * c) -
                                        f.earlier * AxisAngleFromRotation(a.transpose() * b)))
                                 .squaredNorm();
      if (!std::isfinite(squared)) continue;
      squares += squared;
      ++count;
    }
    rms[j] = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  }
  return rms;
}

std::vector<Smoothness> FitSmoothness(const SequenceProblem& problem, const Smoothness& before) {
  std::vector<Smoothness> fitted(1 + ShotOfFrames(problem.cut_before).back(), before);
  for (size_t shot = 0; shot < fitted.size(); ++shot) {
    const std::vector<double> rms = TipAccelerationRms(problem, static_cast<int>(shot));
    double squares = 0;
    for (const double r : rms) squares += r * r;
    if (!(squares > 0)) continue;
    const double all = std::sqrt(squares / static_cast<double>(problem.layout.active_joints.size()));
    const double sigma = std::clamp(kSigmaOfRms * all, kMinSigma, kMaxSigma);
    Smoothness& smooth = fitted[shot];
    smooth.root_acceleration *= sigma / before.tip_acceleration;
    smooth.weak_scale_acceleration *= sigma / before.tip_acceleration;
    smooth.tip_acceleration = sigma;
    smooth.of_joint.resize(rms.size());
    for (size_t j = 0; j < rms.size(); ++j) {
      smooth.of_joint[j] = std::clamp(kSigmaOfRms * rms[j], kMinOfJoint, kMaxOfJoint);
    }
  }
  return fitted;
}

TrackSequenceResult FitClip(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  CheckInput(input, options);
  TrackSequenceResult result;
  ClipFit fit(input, options, &result.summary);
  if (!fit.FindStart()) return result;
  fit.Observe();
  fit.FitCoarseFrames();
  fit.FitAllFrames();
  fit.FinishWithCeres();
  fit.Finish(&result);
  return result;
}

}  // namespace bodyloom
