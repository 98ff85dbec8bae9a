// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/balance/clip_balance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "geometry/base/parallel.h"
#include "geometry/body/balance.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/mass_centre.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/balance/balance.h"
#include "tracking/terms/ground_contact/ground_contact.h"
#include "tracking/terms/surface_contact/clip_contacts.h"

namespace bodyloom {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kMinWeight = 0.02;  ///< frames with less have no term

/// The point of a hull nearest to a point outside of it: share · corner `a` + (1 − share) · corner `b`.
struct NearestOnHull {
  size_t a = 0, b = 0;
  double share = 1;
};

NearestOnHull FindNearest(const std::vector<Vector2d>& hull, const Vector2d& point) {
  NearestOnHull nearest;
  double minimum = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < hull.size(); ++k) {
    const size_t next = (k + 1) % hull.size();
    const Vector2d edge = hull[next] - hull[k];
    const double length2 = edge.squaredNorm();
    const double along = length2 > 0 ? std::clamp((point - hull[k]).dot(edge) / length2, 0.0, 1.0) : 0;
    const double distance = (point - hull[k] - along * edge).norm();
    if (distance >= minimum) continue;
    minimum = distance;
    nearest = {k, next, 1 - along};
  }
  return nearest;
}

}  // namespace

ClipBalance::ClipBalance(const ClipTermInput& clip)
    : weight_(clip.options.ground.balance_weight),
      num_threads_(clip.num_threads),
      points_(FindContactPoints(*clip.layout.model)),
      centre_of_mass_(CompileCentreOfMass(*clip.layout.model, clip.layout.num_betas)) {}

void ClipBalance::Observe(SequenceProblem* problem) {
  for (FrameData& frame : problem->frames) frame.Get<BalanceTerm>();
}

void ClipBalance::StartRound(int /*round*/, const std::vector<int>& /*frames*/, SequenceProblem* problem) {
  const int T = static_cast<int>(problem->frames.size());
  const Matrix3Xd centres = CentresOfMass(*problem, centre_of_mass_, num_threads_);
  std::vector<Matrix3Xd> places(T);
  ParallelFor(T, num_threads_, [&](int t) {
    thread_local ContactPlaces at;
    if (problem->frames[t].ground != nullptr) at.Evaluate(*problem, t, points_, &places[t]);
  });
  ParallelFor(T, num_threads_, [&](int t) {
    FrameData& frame = problem->frames[t];
    auto& term = *frame.terms.Find<BalanceTerm>();
    term.centre_of_mass = nullptr;
    if (frame.ground == nullptr) return;
    const CentreMotion motion = MotionAround(*problem, centres, t);
    if (!motion.found) return;
    const Vector3d up = frame.ground->up, e1 = up.unitOrthogonal(), e2 = up.cross(e1);
    const double lift = kGravity + motion.acceleration.dot(up);
    const double slow = motion.acceleration.norm() / kSlowAcceleration;
    const double weight = weight_ / (1 + std::pow(slow, 4));
    if (weight < kMinWeight || !(lift > 0)) return;
    std::vector<Vector2d> touching;
    std::vector<int> index;
    Eigen::Index lowest = 0;
    (up.transpose() * places[t]).minCoeff(&lowest);
    const Vector3d bottom = places[t].col(lowest);
    for (size_t k = 0; k < points_.size(); ++k) {
      const Vector3d place = places[t].col(static_cast<Eigen::Index>(k));
      const double away = Vector2d(e1.dot(place - bottom), e2.dot(place - bottom)).norm();
      const double tilt_m = kTiltSigmas * frame.ground->measured_up_sigma_rad * away;
      if (up.dot(place) - frame.ground->level_m > kTouchingM + tilt_m) continue;
      touching.emplace_back(e1.dot(place), e2.dot(place));
      index.push_back(points_[k].vertex);
    }
    if (touching.empty()) return;
    const double height = up.dot(motion.place) - frame.ground->level_m;
    const Vector3d horizontal = motion.acceleration - motion.acceleration.dot(up) * up;
    Vector3d offset = motion.place - centres.col(t) - height / lift * horizontal;
    const Vector3d zmp = centres.col(t) + offset;
    const Vector2d point(e1.dot(zmp), e2.dot(zmp));
    const std::vector<Vector2d> hull = ConvexHull(touching);
    if (DistanceOutside(hull, point) == 0) return;
    const NearestOnHull nearest = FindNearest(hull, point);
    const auto vertex_at = [&](size_t k) {
      return index[static_cast<size_t>(std::find(touching.begin(), touching.end(), hull[k]) - touching.begin())];
    };
    term.centre_of_mass = &centre_of_mass_;
    term.vertices = {vertex_at(nearest.a), vertex_at(nearest.b)};
    term.share = nearest.share;
    term.weight = weight;
    term.offset_m = offset;
    term.horizontal.row(0) = e1.transpose();
    term.horizontal.row(1) = e2.transpose();
    if (const CameraPose* camera = frame.camera_from_scene; camera != nullptr) {
      term.offset_m = camera->camera_from_world_rotation * offset;
      term.horizontal *= camera->camera_from_world_rotation.transpose();
    }
  });
}

std::vector<PlanEntry> PlanBalance(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::string why_not = WhyNoGround(input, options);
  if (why_not.empty() && MassByJoint(*input.body).size() == 0) why_not = "the body lacks joints of SMPL's";
  if (why_not.empty() && !(options.ground.balance_weight > 0)) why_not = "switched off";
  return {
      {"balance", why_not.empty(),
       why_not.empty() ? "in slow frames whose zero-moment point lies outside of what touches the ground" : why_not}};
}

std::unique_ptr<ClipTerm> MakeClipBalance(const ClipTermInput& clip) {
  if (!PlanBalance(clip.input, clip.options).front().runs) return nullptr;
  return std::make_unique<ClipBalance>(clip);
}

}  // namespace bodyloom
