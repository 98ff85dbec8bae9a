// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/ground_contact/clip_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/initialise/view_observations.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/contact_points.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/upright.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUpSigmaDegrees = 180 / M_PI;
constexpr double kKnownUpRad = 0.005;  ///< σ of a vertical that is given
constexpr double kViewTurnRad = 0.05;  ///< σ of an estimated rotation between two views (docs/lab/two_views.md)

/// A direction of the scene in a frame's camera.
Vector3d InCamera(const FrameData& frame, const Vector3d& direction) {
  return frame.camera_from_scene == nullptr ? direction
                                            : frame.camera_from_scene->camera_from_world_rotation * direction;
}

/// The ground on which the body rests with any part, and the stances on it.
GroundPlane RestOn(const SupportLevels& supports, const std::vector<std::array<FootPlace, 2>>& feet,
                   const std::vector<double>& timestamps, const JoinedVertical& vertical) {
  const SupportLevel& level = supports.levels.front();
  GroundPlane ground = StandOnPlane(feet, timestamps, vertical.up, level.level_m + kAnkleHeight, {});
  ground.found = true;
  ground.why = supports.why;
  ground.up_sigma_rad = std::sqrt(2) * vertical.sigma_rad;
  ground.offset_sigma_m = level.sigma_m;
  return ground;
}

/// The lowest of the points in frames `index` of a problem; no evidence where its leg's ankle is not `seen`, as that
/// leg is where the pose prior has it.
std::vector<LowestPoint> LowestPoints(const SequenceProblem& problem, const std::vector<ContactPoint>& points,
                                      const std::vector<int>& index, const std::vector<std::array<FootPlace, 2>>& feet,
                                      const Vector3d& up) {
  const BodyModel& body = *problem.layout.model;
  const int head = body.FindJoint("head"), wrists[2] = {body.FindJoint("l_wrist"), body.FindJoint("r_wrist")};
  std::vector<LowestPoint> lowest(index.size());
  if (points.empty()) return lowest;
  ContactPlaces places;
  std::vector<Eigen::Matrix3Xd> at(index.size());
  for (size_t i = 0; i < index.size(); ++i) places.Evaluate(problem, index[i], points, &at[i]);
  const auto highest = [&](size_t i, int joint) {
    double height = -std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < points.size(); ++k) {
      if (points[k].joint == joint) height = std::max(height, up.dot(at[i].col(static_cast<Eigen::Index>(k))));
    }
    return height;
  };
  for (size_t i = 0; i < index.size(); ++i) {
    Eigen::Index k = 0;
    (up.transpose() * at[i]).minCoeff(&k);
    const size_t before = i > 0 ? i - 1 : i, after = i + 1 < index.size() ? i + 1 : i;
    const double seconds = problem.timestamps[index[after]] - problem.timestamps[index[before]];
    const double moved = (at[after].col(k) - at[before].col(k)).norm();
    // Somebody who hangs has both hands overhead, and legs that rest on nothing.
    const double above = highest(i, head);
    const bool may_hang = highest(i, wrists[0]) > above && highest(i, wrists[1]) > above;
    const int leg = points[static_cast<size_t>(k)].leg;
    const bool is_seen = leg < 0 || feet[i][leg].seen;
    lowest[i] = {problem.timestamps[index[i]], at[i].col(k), seconds > 0 ? moved / seconds : 0, is_seen && !may_hang};
  }
  return lowest;
}

}  // namespace

UpEstimate UpInScene(std::span<const LiftedFrame> lifted, std::span<const FrameData> frames) {
  if (frames.front().camera_from_scene == nullptr) return EstimateUp(lifted);
  std::vector<CameraPose> camera_from_scene;
  for (const FrameData& frame : frames) camera_from_scene.push_back(*frame.camera_from_scene);
  return EstimateUp(lifted, camera_from_scene);
}

ClipGround::ClipGround(const ClipTermInput& clip)
    : options_(clip.options.ground),
      keypoints_(clip.joints),
      known_(clip.input.ground),
      lines_(known_ == nullptr ? clip.input.picture_vertical : nullptr),
      lifted_(clip.lifted.frames),
      landmarks_(clip.lifted_landmarks),
      views_(clip.views),
      why_not_(WhyNoGround(clip.input, clip.options)) {
  if (clip.input.views == nullptr) return;
  for (const ViewInput& view : *clip.input.views) {
    view_lines_.push_back(view.camera_from_own == nullptr ? view.picture_vertical : nullptr);
    view_paths_.push_back(view.camera_from_own);
  }
}

std::unique_ptr<ClipTerm> MakeClipGround(const ClipTermInput& clip) { return std::make_unique<ClipGround>(clip); }

void ClipGround::Observe(SequenceProblem* problem) {
  if (lifted_.empty() || !why_not_.empty()) return;
  for (FrameData& frame : problem->frames) frame.Get<GroundContactTerm>();
}

void ClipGround::BeginFit(SequenceProblem* problem) {
  if (lifted_.empty()) return;
  if (problem->layout.focal_column >= 0) focal_log_sigma_ = problem->log_focal_sigma;
  timestamps_ = problem->timestamps;
  const int T = static_cast<int>(lifted_.size());
  for (int begin = 0, end = 0; begin < T; begin = end) {
    for (end = begin + 1; end < T && !problem->cut_before[end];) ++end;
    Shot& shot = shots_.emplace_back();
    shot.begin = begin;
    shot.end = end;
    shot.up_of_first = UpInScene({lifted_.data() + begin, lifted_.data() + end},
                                 {problem->frames.data() + begin, problem->frames.data() + end});
    FindVertical(*problem, &shot);
    if (shot.up.found) SetUpright(shot, shot.joined.up, problem);
  }
}

void ClipGround::FindVertical(const SequenceProblem& problem, Shot* shot) const {
  shot->up = shot->up_of_first;
  if (known_ != nullptr) {
    shot->up.found = true;
    shot->up.up = known_->up;
  } else if (!views_.empty()) {
    std::vector<UpOfView> ups;
    if (shot->up.found) ups.push_back({shot->up.up, Vector3d::UnitZ()});
    for (size_t v = 0; v < views_.size(); ++v) {
      const std::optional<UpOfView> there = UpInOwnScene(v, problem, *shot);
      const Eigen::Matrix3d& R = problem.views[v].camera_from_scene.camera_from_world_rotation;
      if (there) ups.push_back({R.transpose() * there->up, R.transpose() * there->axis});
    }
    if (!ups.empty()) {
      const JoinedUps joined = JoinUps(ups);
      shot->up.found = true;
      shot->up.up = joined.up;
      shot->up_sigma_rad = joined.sigma_rad;
    }
  }
  JoinLines(problem, shot);
}

std::optional<UpOfView> ClipGround::UpInOwnScene(size_t v, const SequenceProblem& problem, const Shot& shot) const {
  if (views_[v].lifted.empty()) return std::nullopt;
  const std::vector<double>& times = views_[v].keypoints.timestamps;
  const double offset = problem.views[v].offset_s;
  const auto at = [&](double time) { return std::lower_bound(times.begin(), times.end(), time) - times.begin(); };
  const auto first = at(timestamps_[shot.begin] + offset), last = at(timestamps_[shot.end - 1] + offset);
  if (last <= first) return std::nullopt;
  const auto frames = std::span(views_[v].lifted).subspan(first, last - first);
  UpOfView result{Vector3d::Zero(), Vector3d::UnitZ()};
  const std::vector<CameraPose>* path = view_paths_[v];
  if (path != nullptr) result.axis = (*path)[(first + last) / 2].camera_from_world_rotation.row(2);
  const UpEstimate up =
      path == nullptr ? EstimateUp(frames) : EstimateUp(frames, std::span(*path).subspan(first, last - first));
  if (!up.found) return std::nullopt;
  result.up = up.up;
  return result;
}

void ClipGround::JoinLines(const SequenceProblem& problem, Shot* shot) const {
  shot->joined = {.up = shot->up.up, .sigma_rad = known_ != nullptr ? kKnownUpRad : shot->up_sigma_rad};
  if (known_ != nullptr || !shot->up.found) return;
  if (lines_ != nullptr) {
    shot->joined =
        JoinVerticals(shot->up.up, shot->joined.sigma_rad, *lines_, std::exp(problem.log_focal), focal_log_sigma_);
  }
  for (size_t v = 0; v < view_lines_.size(); ++v) {
    if (view_lines_[v] == nullptr) continue;
    const ViewLayout& layout = problem.layout.views[v];
    const Eigen::Matrix3d& R = problem.views[v].camera_from_scene.camera_from_world_rotation;
    PictureVertical lines = *view_lines_[v];
    if (layout.pose_column >= 0) lines.covariance += kViewTurnRad * kViewTurnRad * Eigen::Matrix3d::Identity();
    JoinedVertical joined =
        JoinVerticals(R * shot->joined.up, shot->joined.sigma_rad, lines, std::exp(problem.views[v].log_focal),
                      layout.focal_column >= 0 ? layout.log_focal_sigma : 0);
    if (!joined.used) continue;
    joined.up = R.transpose() * joined.up;
    shot->joined = joined;
  }
}

void ClipGround::SetUpright(const Shot& shot, const Vector3d& up, SequenceProblem* problem) const {
  if (!options_.use_up) return;
  for (int t = shot.begin; t < shot.end; ++t) {
    FrameData& frame = problem->frames[t];
    const Vector3d up_in_camera = InCamera(frame, up);
    const Vector3d level = Vector3d::UnitZ() - up_in_camera.z() * up_in_camera;
    // Seen from straight above or below, no direction of lean is more ambiguous than another.
    if (level.norm() >= 0.1) frame.Get<UprightTerm>().normal = level.normalized();
  }
}

void ClipGround::Hold(const Stance& stance, const GroundPlane& ground, FrameData* frame) const {
  GroundContact contact;
  contact.point = &landmarks_.points[kLifterLeftAnkle + stance.foot];
  contact.target_m = stance.place_m;
  const Vector3d along = ground.normal.unitOrthogonal();
  contact.whitening.row(0) = along.transpose() / options_.sigma_slide_m;
  contact.whitening.row(1) = ground.normal.cross(along).transpose() / options_.sigma_slide_m;
  contact.whitening.row(2) = ground.normal.transpose() / options_.sigma_height_m;
  contact.whitening *= std::sqrt(options_.contact_weight);
  if (const CameraPose* camera = frame->camera_from_scene; camera != nullptr) {
    contact.target_m = MovedPoint(*camera, stance.place_m);
    contact.whitening *= camera->camera_from_world_rotation.transpose();
  }
  frame->Get<GroundContactTerm>().feet.push_back(contact);
}

GroundPlane ClipGround::PlaneUnder(const std::vector<std::array<FootPlace, 2>>& feet,
                                   const std::vector<double>& timestamps, const JoinedVertical& vertical) const {
  const Vector3d& up = vertical.up;
  GroundPlaneOptions options = GroundPlaneOptions::OfViews(1 + views_.size());
  options.up_rad = vertical.sigma_rad;
  if (known_ == nullptr) return EstimateGroundPlane(feet, timestamps, up, options);
  if (known_->has_plane) {
    // Somebody may stand on a box: then the plane does not apply to them, but the vertical does.
    GroundPlane known = StandOnPlane(feet, timestamps, up, kAnkleHeight - known_->camera_height_m, options);
    if (known.found) return known;
  }
  return EstimateGroundPlane(feet, timestamps, up, options);
}

void ClipGround::StandOnFloors(const SupportLevels& levels, const std::vector<int>& index,
                               const std::vector<int>& frames, Shot* shot, SequenceProblem* coarse,
                               SequenceProblem* problem) const {
  shot->levels = levels.levels;
  for (const SupportLevel& level : levels.levels) {
    shot->floors.push_back(std::make_unique<FrameGround>(
        FrameGround{shot->ground.normal, level.level_m, shot->joined.up, shot->joined.sigma_rad,
                    shot->ground.up_sigma_rad / std::sqrt(2), shot->ground.offset_sigma_m,
                    GroundPlaneOptions::OfViews(1 + views_.size()).depth_m}));
  }
  for (size_t i = 0; i < index.size(); ++i) {
    FrameGround* floor = shot->floors[levels.of_frame[i]].get();
    coarse->frames[index[i]].ground = floor;
    // Frames between two coarse ones belong to the nearer one.
    const int here = frames[index[i]];
    const int from = i > 0 ? (frames[index[i - 1]] + here) / 2 + 1 : shot->begin;
    const int to = i + 1 < index.size() ? (here + frames[index[i + 1]]) / 2 + 1 : shot->end;
    for (int t = from; t < to; ++t) problem->frames[t].ground = floor;
  }
}

bool ClipGround::LearnFrom(const std::vector<int>& frames, SequenceProblem* coarse, SequenceProblem* problem) {
  if (lifted_.empty() || !why_not_.empty()) return false;
  const std::vector<std::array<FootPlace, 2>> all_feet =
      ObservedFeet(*coarse, frames, lifted_, landmarks_, *keypoints_);
  standing_speed_mps_ = StandingSpeed(all_feet, coarse->timestamps, {});
  const std::vector<ContactPoint> points = FindContactPoints(*coarse->layout.model);
  std::vector<char> held(lifted_.size(), 0);
  bool any = false;
  for (Shot& shot : shots_) {
    FindVertical(*coarse, &shot);
    if (!shot.up.found) {
      shot.ground.why = "the vertical is not clear";
      continue;
    }
    std::vector<std::array<FootPlace, 2>> feet;
    std::vector<double> timestamps;
    std::vector<int> index;  // in `coarse`
    for (size_t i = 0; i < frames.size(); ++i) {
      const int t = frames[i];
      if (t < shot.begin || t >= shot.end) continue;
      feet.push_back(all_feet[i]);
      timestamps.push_back(coarse->timestamps[i]);
      index.push_back(static_cast<int>(i));
    }
    for (const Stance& stance : FindStances(feet, timestamps, {})) {
      shot.stances.push_back({.foot = stance.foot,
                              .begin = frames[index[stance.begin]],
                              .end = frames[index[stance.end - 1]] + 1,
                              .seconds = stance.seconds});
    }
    shot.ground = PlaneUnder(feet, timestamps, shot.joined);
    const std::optional<double> level =
        shot.ground.found ? std::optional(shot.ground.offset_m - kAnkleHeight) : std::nullopt;
    const SupportLevels supports = FindSupportLevels(LowestPoints(*coarse, points, index, feet, shot.ground.normal),
                                                     shot.ground.normal, shot.joined.sigma_rad, level);
    if (!shot.ground.found && !supports.levels.empty()) shot.ground = RestOn(supports, feet, timestamps, shot.joined);
    if (!shot.ground.found) {
      SetUpright(shot, shot.joined.up, problem);
      continue;
    }
    any = true;
    SetUpright(shot, shot.ground.normal, problem);
    StandOnFloors(supports, index, frames, &shot, coarse, problem);
    for (const Stance& stance : shot.ground.stances) {
      const int first = frames[index[stance.begin]], last = frames[index[stance.end - 1]];
      for (int i = stance.begin; i < stance.end; ++i) Hold(stance, shot.ground, &coarse->frames[index[i]]);
      for (int t = first; t <= last; ++t) {
        Hold(stance, shot.ground, &problem->frames[t]);
        held[t] = 1;
      }
    }
    for (const int i : index) {
      coarse->frames[i].Get<UprightTerm>().normal = problem->frames[frames[i]].Get<UprightTerm>().normal;
    }
  }
  contact_frames_ = static_cast<int>(std::count(held.begin(), held.end(), 1));
  return any;
}

void ClipGround::PlaceOnFloor(const SequenceProblem& problem, const Vector3d& up,
                              std::vector<StandingFoot>* stances) const {
  Kinematics kinematics;
  PointEvaluator points;
  for (StandingFoot& stance : *stances) {
    Vector3d sum = Vector3d::Zero();
    for (int t = stance.begin; t < stance.end; ++t) {
      const FrameState& state = problem.states[t];
      kinematics.Set(*problem.layout.model, problem.betas, state.rotations, Vector3d::Zero(), false);
      sum += points.Evaluate(kinematics, landmarks_.points[kLifterLeftAnkle + stance.foot], false) +
             problem.layout.BodyPlace(state);
    }
    stance.place_m = sum / (stance.end - stance.begin) - kAnkleHeight * up;
  }
}

void ClipGround::Summarise(const SequenceProblem& problem, TrackSequenceSummary* summary) const {
  GroundSummary& result = summary->ground;
  if (!why_not_.empty()) result.why = why_not_;
  const auto longest = std::max_element(shots_.begin(), shots_.end(),
                                        [](const Shot& a, const Shot& b) { return a.end - a.begin < b.end - b.begin; });
  if (longest == shots_.end()) return;
  result.has_up = longest->up.found;
  result.up = longest->floors.empty() ? longest->joined.up : longest->floors.front()->up;
  result.up_spread_deg = longest->up.spread_deg;
  result.given = known_ != nullptr;
  result.up_sigma_deg =
      known_ != nullptr ? known_->up_sigma_deg : kUpSigmaDegrees * std::sqrt(2) * longest->joined.sigma_rad;
  if (lines_ != nullptr && lines_->found && longest->up.found && !longest->joined.used) {
    summary->plan.push_back({"vertical from lines in the fit", false,
                             Concatenate(std::lround(longest->joined.angle_deg), "° off the lifter's, expected up to ",
                                         kMaxPictureVerticalAngleDeg, "°")});
  }
  result.contact_frames = contact_frames_;
  result.standing_speed_mps = standing_speed_mps_;
  if (!why_not_.empty()) return;
  result.stances = longest->stances;
  PlaceOnFloor(problem, result.up, &result.stances);
  const GroundPlane& ground = longest->ground;
  result.has_plane = ground.found;
  result.why = ground.why;
  for (size_t k = 1; k < longest->levels.size(); ++k) {
    const double higher = longest->floors[k]->level_m - longest->floors[0]->level_m;
    result.why += Concatenate("; ", std::round(10 * longest->levels[k].seconds) / 10, " s ",
                              std::round(100 * std::abs(higher)) / 100, " m ", higher > 0 ? "above" : "below", " it");
  }
  if (!ground.found) return;
  result.camera_height_m = -longest->floors.front()->level_m;
  const FrameGround& floor = *longest->floors.front();
  if (known_ == nullptr) result.up_sigma_deg = kUpSigmaDegrees * std::sqrt(2) * floor.up_sigma_rad;
  const bool on_known = std::isnan(ground.offset_sigma_m);
  result.height_sigma_m = on_known && known_ != nullptr ? known_->height_sigma_m : floor.level_sigma_m;
  result.height_spread_m = ground.spread_m;
}

}  // namespace bodyloom
