// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/clip_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "geometry/scene/camera_path.h"
#include "geometry/scene/time_bracket.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/problem/moving_camera.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/surface_contact/surface_contact.h"

namespace bodyloom {

using Eigen::Vector2d;

namespace {

constexpr double kMaxBridge_s = 0.15;    // between detections that are interpolated
constexpr double kSlopeWithin_s = 0.06;  // of a velocity, to each side

Camera CameraOfView(const ViewInput& view) {
  Camera camera = view.camera;
  if (camera.width == 0) camera.width = view.keypoints->image_width;
  if (camera.height == 0) camera.height = view.keypoints->image_height;
  if (view.knowledge == CameraKnowledge::kKnown) return camera;
  const FocalPrior prior = view.focal_prior.value_or(FocalPrior::ForImage(camera.width, camera.height));
  return MakePinhole(camera.width, camera.height, camera.fx > 0 ? camera.fx : std::exp(prior.log_mean));
}

bool IsUsable(const Keypoint& point) {
  return point.confidence >= kMinConfidence && std::isfinite(point.x) && std::isfinite(point.y);
}

double MiddleOf(const std::vector<double>& timestamps) { return 0.5 * (timestamps.front() + timestamps.back()); }

/// Slope of the least-squares line through the detections of a landmark near time t.
Vector2d SlopeNear(const KeypointSequence& keypoints, int k, double t) {
  const std::vector<double>& times = keypoints.timestamps;
  const auto first = std::lower_bound(times.begin(), times.end(), t - kSlopeWithin_s) - times.begin();
  double n = 0, mean_t = 0;
  Vector2d mean = Vector2d::Zero();
  const auto visit = [&](const auto& f) {
    for (auto i = first; i < static_cast<std::ptrdiff_t>(times.size()) && times[i] <= t + kSlopeWithin_s; ++i) {
      const Keypoint& point = keypoints.at(static_cast<int>(i), k);
      if (IsUsable(point)) f(times[i] - t, Vector2d(point.x, point.y));
    }
  };
  visit([&](double s, const Vector2d& y) {
    n += 1;
    mean_t += s;
    mean += y;
  });
  if (n < 2) return Vector2d::Zero();
  mean_t /= n;
  mean /= n;
  double square = 0;
  Vector2d product = Vector2d::Zero();
  visit([&](double s, const Vector2d& y) {
    square += (s - mean_t) * (s - mean_t);
    product += (s - mean_t) * (y - mean);
  });
  return square > 0 ? Vector2d(product / square) : Vector2d::Zero();
}

}  // namespace

std::vector<SampledKeypoint> SampleKeypoints(const KeypointSequence& keypoints, double t) {
  std::vector<SampledKeypoint> result(keypoints.num_points());
  const std::optional<TimeBracket> at = FindTimeBracket(keypoints.timestamps, t);
  if (!at || at->gap_s > kMaxBridge_s) return result;
  const auto s = static_cast<float>(at->s);
  for (int k = 0; k < keypoints.num_points(); ++k) {
    const Keypoint &p = keypoints.at(at->before, k), &q = keypoints.at(at->after, k);
    if (!IsUsable(p) || !IsUsable(q)) continue;
    result[k].point = {(1 - s) * p.x + s * q.x, (1 - s) * p.y + s * q.y, std::min(p.confidence, q.confidence)};
    result[k].velocity_px_s = SlopeNear(keypoints, k, t);
  }
  return result;
}

void AddViews(const TrackSequenceInput& input, SequenceProblem* problem) {
  if (input.views == nullptr) return;
  for (const ViewInput& view : *input.views) {
    const Camera camera = CameraOfView(view);
    problem->layout.AddView({view.knowledge, camera, !view.pose_known, !view.clock_known});
    ViewLayout& layout = problem->layout.views.back();
    const FocalPrior prior = view.focal_prior.value_or(FocalPrior::ForImage(camera.width, camera.height));
    layout.log_focal_prior = prior.log_mean;
    layout.log_focal_sigma = prior.log_sigma;
    if (view.focal_ratio_log_sigma > 0) {
      const Camera& first = problem->layout.camera;
      const double log_ratio =
          std::log(static_cast<double>(std::max(camera.width, camera.height)) / std::max(first.width, first.height));
      if (problem->layout.focal_column >= 0) {
        layout.log_ratio_prior = log_ratio;
        layout.log_ratio_sigma = view.focal_ratio_log_sigma;
      } else {
        layout.log_focal_prior = std::log(first.fx) + log_ratio;
        layout.log_focal_sigma = view.focal_ratio_log_sigma;
      }
    }
    layout.offset_prior_s = view.offset_s;
    layout.offset_sigma_s = view.offset_sigma_s;
    layout.rate_prior = view.rate;
    problem->views.push_back({view.camera_from_scene, std::log(camera.fx), view.offset_s, view.rate});
  }
}

ClipViews::ClipViews(const ClipTermInput& clip)
    : stature_m_(clip.stature_m),
      lifter_weight_(clip.options.lifter_weight),
      lifted_landmarks_(CompileLiftedLandmarks(*clip.input.body, clip.layout.num_betas)) {
  const double metres = LifterMetres(*clip.input.body, Eigen::VectorXd());
  for (size_t v = 0; v < clip.views.size(); ++v) {
    View& view = views_.emplace_back();
    view.clock_known = (*clip.input.views)[v].clock_known;
    view.keypoints = &clip.views[v].keypoints;
    view.path = (*clip.input.views)[v].camera_from_own;
    view.landmarks = FindObservedLandmarks(*clip.input.body, view.keypoints, clip.layout.num_betas);
    for (const LiftedFrame& frame : clip.views[v].lifted) {
      view.lifted.push_back(MakeLiftedPose(frame, lifted_landmarks_, metres, clip.options.lifter_min_sigma_m));
    }
  }
}

void ClipViews::Observe(SequenceProblem* problem) {
  middle_s_ = MiddleOf(problem->timestamps);
  for (size_t t = 0; t < problem->frames.size(); ++t) {
    for (int v = 0; v < static_cast<int>(views_.size()); ++v) {
      ViewTerms& terms = problem->frames[t].views.emplace_back();
      terms.view = v;
      terms.clock_s = problem->timestamps[t] - middle_s_;
      ObserveFrame(v, t, problem);
    }
  }
}

ClipTerm::Rounds ClipViews::rounds() const {
  const bool sought = std::any_of(views_.begin(), views_.end(), [](const View& view) { return !view.clock_known; });
  return sought ? Rounds{.count = 2, .max_iterations = 8, .stage = "fit clocks"} : Rounds{};
}

void ClipViews::StartRound(int /*round*/, const std::vector<int>& /*frames*/, SequenceProblem* problem) {
  for (size_t i = 0; i < problem->frames.size(); ++i) {
    for (int v = 0; v < static_cast<int>(views_.size()); ++v) ObserveFrame(v, i, problem);
  }
}

CameraPose ClipViews::PoseAt(const View& view, double t) {
  const std::vector<double>& times = view.keypoints->timestamps;
  const double inside = std::clamp(t, times.front(), times.back());
  const std::optional<TimeBracket> at = FindTimeBracket(times, inside);
  return InterpolatePoses((*view.path)[at->before], (*view.path)[at->after], at->s);
}

void ClipViews::ObserveFrame(int v, size_t i, SequenceProblem* problem) const {
  const View& view = views_[v];
  const ViewState& state = problem->views[v];
  const FrameLayout& local = *problem->layout.views[v].local;
  ViewTerms& terms = problem->frames[i].views[v];
  terms.sampled_s = state.offset_s + state.rate * terms.clock_s;
  const double t = problem->timestamps[i] + terms.sampled_s;
  if (view.path != nullptr) terms.camera_from_own = PoseAt(view, t);
  const FrameState in_view = StateInCamera(local, CameraOfView(terms, state), problem->betas, problem->states[i]);
  const double height_px = std::exp(state.log_focal) * stature_m_ / std::max(0.3, in_view.translation.z());
  auto& landmarks = terms.terms.Get<LandmarkTerm>();
  landmarks.seen.clear();
  const std::vector<SampledKeypoint> sampled = SampleKeypoints(*view.keypoints, t);
  for (size_t k = 0; k < view.landmarks.names.size(); ++k) {
    const SampledKeypoint& seen = sampled[view.landmarks.keypoint_column[k]];
    if (!IsUsable(seen.point)) continue;
    landmarks.seen.push_back({&view.landmarks.points[k],
                              {seen.point.x, seen.point.y},
                              kSeveralViewsSigma * KeypointSigmaPx(seen.point.confidence, height_px),
                              seen.velocity_px_s});
  }
  if (view.path != nullptr && !view.clock_known) {
    // The camera's pose is that of `sampled_s`: an observation moves by the person's own velocity alone.
    Kinematics kinematics;
    kinematics.Set(*problem->layout.model, problem->betas, in_view.rotations, in_view.translation, false);
    PointEvaluator points;
    Camera camera = local.camera;
    if (local.focal_column >= 0) camera.fx = camera.fy = std::exp(state.log_focal);
    const CameraPose own_from_camera = Inverse(*terms.camera_from_own);
    const CameraPose before = Compose(PoseAt(view, t - kSlopeWithin_s), own_from_camera);
    const CameraPose after = Compose(PoseAt(view, t + kSlopeWithin_s), own_from_camera);
    for (LandmarkObservation& seen : landmarks.seen) {
      const Eigen::Vector3d point = points.Evaluate(kinematics, *seen.point, false);
      Vector2d from, to;
      if (!camera.Project(MovedPoint(before, point), &from) || !camera.Project(MovedPoint(after, point), &to)) continue;
      seen.velocity_px_s -= (to - from) / (2 * kSlopeWithin_s);
    }
  }
  auto& lifted = terms.terms.Get<LiftedPoseTerm>();
  lifted.pose = nullptr;
  lifted.weight = lifter_weight_;
  const std::vector<double>& times = view.keypoints->timestamps;
  if (view.lifted.empty() || landmarks.seen.empty()) return;
  auto nearest = std::lower_bound(times.begin(), times.end(), t) - times.begin();
  if (nearest == static_cast<std::ptrdiff_t>(times.size()) ||
      (nearest > 0 && t - times[nearest - 1] < times[nearest] - t)) {
    --nearest;
  }
  lifted.pose = &view.lifted[nearest];
}

void ClipViews::Summarise(const SequenceProblem& problem, TrackSequenceSummary* summary) const {
  for (size_t v = 0; v < views_.size(); ++v) {
    const ViewLayout& layout = problem.layout.views[v];
    const ViewState& state = problem.views[v];
    ViewSummary& view = summary->views.emplace_back();
    view.camera = layout.local->camera;
    if (layout.focal_column >= 0) view.camera.fx = view.camera.fy = std::exp(state.log_focal);
    view.camera_from_scene = state.camera_from_scene;
    view.offset_s = state.offset_s;
    view.rate = state.rate;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    view.rotation_sigma_rad = view.translation_sigma_m = layout.pose_column >= 0 ? unknown : 0;
    view.focal_log_sigma = layout.focal_column >= 0 ? unknown : 0;
    view.offset_sigma_s = view.rate_sigma = layout.clock_column >= 0 ? unknown : 0;
    std::vector<double> errors;
    for (size_t t = 0; t < problem.frames.size(); ++t) {
      const auto& seen = problem.frames[t].views[v].terms.Get<LandmarkTerm>().seen;
      view.frames += seen.empty() ? 0 : 1;
      const FrameState in_view = StateInCamera(*layout.local, CameraOfView(problem.frames[t].views[v], state),
                                               problem.betas, problem.states[t]);
      Kinematics kinematics;
      kinematics.Set(*problem.layout.model, problem.betas, in_view.rotations, in_view.translation, false);
      PointEvaluator points;
      Vector2d pixel;
      for (const LandmarkObservation& observation : seen) {
        if (view.camera.Project(points.Evaluate(kinematics, *observation.point, false), &pixel)) {
          errors.push_back((pixel - observation.pixel).norm());
        }
      }
    }
    view.reprojection_median_px = SummarizeTerm("", errors).median_px;
  }
}

void SetViewSigma(const FrameLayout& layout, const Eigen::VectorXd& shared_sigma, TrackSequenceSummary* summary) {
  if (shared_sigma.size() == 0) return;
  for (size_t v = 0; v < layout.views.size(); ++v) {
    const ViewLayout& columns = layout.views[v];
    ViewSummary& view = summary->views[v];
    const auto sigma = [&](int column, int count) {
      return std::sqrt(shared_sigma.segment(column - layout.beta_column, count).squaredNorm() / count);
    };
    if (columns.pose_column >= 0) {
      view.rotation_sigma_rad = kViewSigmaFactor * sigma(columns.pose_column, 3);
      view.translation_sigma_m = kViewSigmaFactor * sigma(columns.pose_column + 3, 3);
    }
    if (columns.focal_column >= 0) {
      view.focal_log_sigma = std::min(kViewSigmaFactor * sigma(columns.focal_column, 1), columns.log_focal_sigma);
    }
    if (columns.clock_column >= 0) {
      const double offset_s = sigma(columns.clock_column, 1), rate = sigma(columns.clock_column + 1, 1);
      view.offset_sigma_s = std::min(kClockSigmaFactor * offset_s, columns.offset_sigma_s);
      view.rate_sigma = std::min(kClockSigmaFactor * rate, columns.rate_sigma);
    }
  }
}

void LeaveGround(SequenceProblem* problem) {
  for (FrameData& frame : problem->frames) {
    frame.Get<GroundContactTerm>().feet.clear();
    frame.Get<SurfaceContactTerm>().contacts.clear();
  }
}

std::vector<PlanEntry> PlanViews(const TrackSequenceInput& input, const TrackSequenceOptions& /*options*/) {
  std::vector<PlanEntry> entries;
  if (input.views == nullptr) return entries;
  for (size_t v = 0; v < input.views->size(); ++v) {
    const ViewInput& view = (*input.views)[v];
    std::string unknown;
    const auto add = [&](bool is_unknown, const char* what) {
      if (is_unknown) unknown += (unknown.empty() ? "" : ", ") + std::string(what);
    };
    add(!view.pose_known, "place and direction");
    add(view.knowledge != CameraKnowledge::kKnown,
        view.focal_ratio_log_sigma > 0 ? "focal length, as the first one's" : "focal length");
    add(!view.clock_known, "clock");
    entries.push_back(
        {"view " + std::to_string(v + 2), true,
         (view.camera_from_own != nullptr ? "moves along its path, " : "") +
             (unknown.empty() ? "its camera and clock are known" : "estimated with the track: " + unknown)});
  }
  return entries;
}

std::unique_ptr<ClipTerm> MakeClipViews(const ClipTermInput& clip) {
  if (clip.input.views == nullptr || clip.input.views->empty()) return nullptr;
  return std::make_unique<ClipViews>(clip);
}

}  // namespace bodyloom
