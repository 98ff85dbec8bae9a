// SPDX-License-Identifier: Apache-2.0
#include "render/view/follow_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

bool IsKnown(const MatrixX3d& frame) { return frame.rows() > 0; }

/// Smooths the root's path over about a second for a smooth camera; lost frames are interpolated.
MatrixX3d SmoothRootPath(const std::vector<MatrixX3d>& joints, const std::vector<double>& times) {
  constexpr double kBlur_s = 0.35;
  const int T = static_cast<int>(joints.size());
  std::vector<int> known;
  for (int t = 0; t < T; ++t) {
    if (IsKnown(joints[t])) known.push_back(t);
  }
  MatrixX3d path = MatrixX3d::Zero(T, 3);
  size_t first = 0;
  for (int t = 0; t < T; ++t) {
    while (first + 1 < known.size() && times[known[first]] < times[t] - 3 * kBlur_s) ++first;
    Vector3d sum = Vector3d::Zero();
    double weights = 0;
    for (size_t i = first; i < known.size() && (i == first || times[known[i]] < times[t] + 3 * kBlur_s); ++i) {
      const double lag = (times[known[i]] - times[t]) / kBlur_s;
      const double weight = std::max(std::exp(-0.5 * lag * lag), 1e-9);  // positive in long gaps
      sum += weight * joints[known[i]].row(0).transpose();
      weights += weight;
    }
    path.row(t) = (sum / weights).transpose();
  }
  return path;
}

/// Vertical bounding cylinder of all points about the origin, as rings of points: rotationally symmetric.
MatrixX3d Cylinder(const std::vector<MatrixX3d>& points, const Vector3d& up) {
  constexpr int kAround = 24;
  double low = 0, high = 0, radius = 0;
  for (const MatrixX3d& frame : points) {
    for (int i = 0; i < frame.rows(); ++i) {
      const double height = frame.row(i).dot(up);
      low = std::min(low, height), high = std::max(high, height);
      radius = std::max(radius, (frame.row(i).transpose() - height * up).norm());
    }
  }
  MatrixX3d rings(2 * kAround, 3);
  const Vector3d spoke = radius * up.unitOrthogonal();
  for (int k = 0; k < kAround; ++k) {
    const Vector3d rim = RotationFromAxisAngle(2 * M_PI * k / kAround * up) * spoke;
    rings.row(2 * k) = (rim + low * up).transpose();
    rings.row(2 * k + 1) = (rim + high * up).transpose();
  }
  return rings;
}

}  // namespace

std::vector<MatrixX3d> TrackJoints(const BodyModel& body, const Track& track) {
  const MatrixX3d rest = body.RestJoints(track.motion.betas);
  std::vector<MatrixX3d> joints(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    const BodyPose pose =
        PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    joints[t] = PoseSkeleton(body, rest, pose).joints;
  }
  return joints;
}

Vector3d EstimatedUp(const Track& track) {
  constexpr double kSteadiness = 0.95, kFurthest_deg = 40;
  if (track.world && track.world->source != WorldSource::kLevelCamera) return track.world->up_in_camera();
  Vector3d camera_up = -Vector3d::UnitY();
  Vector3d sum = Vector3d::Zero();
  int known = 0;
  for (int t = 0; t < track.num_frames(); ++t) {
    const Vector3d root = track.motion.poses.row(t).head<3>().transpose();
    if (!root.allFinite()) continue;
    sum += RotationFromAxisAngle(root) * Vector3d::UnitY();
    ++known;
  }
  if (sum.norm() < kSteadiness * known || known == 0) return camera_up;
  const Vector3d up = sum.normalized();
  return up.dot(camera_up) > std::cos(kFurthest_deg * M_PI / 180) ? up : camera_up;
}

FollowView::FollowView(const std::vector<MatrixX3d>& joints, const std::vector<double>& timestamps,
                       const FollowViewOptions& options, const std::vector<MatrixX3d>& others)
    : options_(options) {
  BODYLOOM_CHECK(std::any_of(joints.begin(), joints.end(), IsKnown),
                 "no frame of the track is known, there is nothing to turn about");
  BODYLOOM_CHECK(timestamps.size() == joints.size() && (others.empty() || others.size() == joints.size()),
                 "follow view: ", joints.size(), " frames, ", timestamps.size(), " timestamps, ", others.size(),
                 " frames of others");
  centre_ = SmoothRootPath(joints, timestamps);
  if (!options.follows) centre_.rowwise() = Eigen::RowVector3d(centre_.colwise().mean());
  for (size_t t = 0; t < joints.size(); ++t) {
    const auto centre = centre_.row(static_cast<Eigen::Index>(t));
    if (IsKnown(joints[t])) around_centre_.push_back(joints[t].rowwise() - centre);
    if (!others.empty() && IsKnown(others[t])) around_centre_.push_back(others[t].rowwise() - centre);
  }
  if (options.turns) around_centre_ = {Cylinder(around_centre_, options.orbit.up_in_camera.normalized())};
  view_ = OrbitView(around_centre_, options.width, options.height, options.orbit);
}

View FollowView::At(int t, double extra_yaw_deg) const {
  View view = view_;
  if (extra_yaw_deg != 0) {
    OrbitOptions orbit = options_.orbit;
    orbit.yaw_deg += extra_yaw_deg;
    view = OrbitView(around_centre_, options_.width, options_.height, orbit);
  }
  CameraPose& pose = view.from_camera;
  pose.camera_from_world_translation -= pose.camera_from_world_rotation * CentreAt(t);
  return view;
}

}  // namespace bodyloom
