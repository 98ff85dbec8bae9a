// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/ground_contact/clip_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "tracking/initialise/ground_plane.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/body_points.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/upright.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUpSigmaDegrees = 180 / M_PI;
constexpr double kKnownUpRad = 0.005;  ///< σ of a vertical that is given

/// A direction of the scene in a frame's camera.
Vector3d InCamera(const FrameData& frame, const Vector3d& direction) {
  return frame.camera_from_scene == nullptr ? direction
                                            : frame.camera_from_scene->camera_from_world_rotation * direction;
}

/// The lifter's up direction, in the scene.
UpEstimate UpInScene(std::span<const LiftedFrame> lifted, std::span<const FrameData> frames) {
  if (frames.front().camera_from_scene == nullptr) return EstimateUp(lifted);
  std::vector<LiftedFrame> turned(lifted.begin(), lifted.end());
  for (size_t t = 0; t < turned.size(); ++t) {
    turned[t].up = frames[t].camera_from_scene->camera_from_world_rotation.transpose() * lifted[t].up;
  }
  return EstimateUp(turned);
}

}  // namespace

ClipGround::ClipGround(const ClipTermInput& clip)
    : options_(clip.options.ground),
      keypoints_(clip.joints),
      known_(clip.input.ground),
      lines_(known_ == nullptr && clip.input.camera_from_scene == nullptr ? clip.input.picture_vertical : nullptr),
      lifted_(clip.lifted.frames),
      landmarks_(clip.lifted_landmarks),
      why_not_(WhyNoGround(clip.input, clip.options)) {}

std::unique_ptr<ClipTerm> MakeClipGround(const ClipTermInput& clip) { return std::make_unique<ClipGround>(clip); }

void ClipGround::Observe(SequenceProblem* problem) {
  if (lifted_.empty() || !why_not_.empty()) return;
  for (FrameData& frame : problem->frames) frame.Get<GroundContactTerm>();
}

void ClipGround::BeginFit(SequenceProblem* problem) {
  if (lifted_.empty()) return;
  if (problem->layout.focal_column >= 0) focal_log_sigma_ = problem->log_focal_sigma;
  const int T = static_cast<int>(lifted_.size());
  for (int begin = 0, end = 0; begin < T; begin = end) {
    for (end = begin + 1; end < T && !problem->cut_before[end];) ++end;
    Shot& shot = shots_.emplace_back();
    shot.begin = begin;
    shot.end = end;
    shot.up = UpInScene({lifted_.data() + begin, lifted_.data() + end},
                        {problem->frames.data() + begin, problem->frames.data() + end});
    if (known_ != nullptr) {
      shot.up.found = true;
      shot.up.up = known_->up;
    }
    JoinLines(*problem, &shot);
    if (shot.up.found) SetUpright(shot, shot.joined.up, problem);
  }
}

void ClipGround::JoinLines(const SequenceProblem& problem, Shot* shot) const {
  shot->joined = {.up = shot->up.up, .sigma_rad = known_ != nullptr ? kKnownUpRad : GroundPlaneOptions().up_rad};
  if (lines_ == nullptr || !shot->up.found) return;
  shot->joined =
      JoinVerticals(shot->up.up, shot->joined.sigma_rad, *lines_, std::exp(problem.log_focal), focal_log_sigma_);
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
  GroundPlaneOptions options;
  options.up_rad = vertical.sigma_rad;
  if (known_ == nullptr) return EstimateGroundPlane(feet, timestamps, up, options);
  if (known_->has_plane) {
    // Somebody may stand on a box: then the plane does not apply to them, but the vertical does.
    GroundPlane known = StandOnPlane(feet, timestamps, up, kAnkleHeight - known_->camera_height_m, options);
    if (known.found) return known;
  }
  return EstimateGroundPlane(feet, timestamps, up, options);
}

bool ClipGround::LearnFrom(const std::vector<int>& frames, SequenceProblem* coarse, SequenceProblem* problem) {
  if (lifted_.empty() || !why_not_.empty()) return false;
  const std::vector<std::array<FootPlace, 2>> all_feet =
      ObservedFeet(*coarse, frames, lifted_, landmarks_, *keypoints_);
  standing_speed_mps_ = StandingSpeed(all_feet, coarse->timestamps, {});
  std::vector<char> held(lifted_.size(), 0);
  bool any = false;
  for (Shot& shot : shots_) {
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
    JoinLines(*coarse, &shot);
    shot.ground = PlaneUnder(feet, timestamps, shot.joined);
    if (!shot.ground.found) {
      SetUpright(shot, shot.joined.up, problem);
      continue;
    }
    any = true;
    SetUpright(shot, shot.ground.normal, problem);
    shot.floor = std::make_unique<FrameGround>();
    *shot.floor = {shot.ground.normal, shot.ground.offset_m - kAnkleHeight};
    for (int t = shot.begin; t < shot.end; ++t) problem->frames[t].ground = shot.floor.get();
    for (const int i : index) coarse->frames[i].ground = shot.floor.get();
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
  result.up = longest->ground.found ? longest->ground.normal : longest->joined.up;
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
  if (!ground.found) return;
  result.camera_height_m = -longest->floor->level_m;
  if (known_ == nullptr) result.up_sigma_deg = kUpSigmaDegrees * ground.up_sigma_rad;
  const bool on_known = std::isnan(ground.offset_sigma_m);
  result.height_sigma_m = on_known && known_ != nullptr ? known_->height_sigma_m : ground.offset_sigma_m;
  result.height_spread_m = ground.spread_m;
}

}  // namespace bodyloom
