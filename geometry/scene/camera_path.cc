// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/camera_path.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kSameMomentS = 1e-3;

void CheckPath(const CameraPath& path) {
  BODYLOOM_CHECK(!path.poses.empty() && path.poses.size() == path.timestamps.size(), "camera path: ", path.poses.size(),
                 " poses at ", path.timestamps.size(), " moments, expected as many, at least one");
  for (size_t i = 0; i < path.timestamps.size(); ++i) {
    BODYLOOM_CHECK(std::isfinite(path.timestamps[i]) && (i == 0 || path.timestamps[i] > path.timestamps[i - 1]),
                   "camera path: pose ", i, " is at ", path.timestamps[i], " s, expected rising times");
  }
}

}  // namespace

CameraPose Compose(const CameraPose& a_from_b, const CameraPose& b_from_c) {
  return {a_from_b.camera_from_world_rotation * b_from_c.camera_from_world_rotation,
          MovedPoint(a_from_b, b_from_c.camera_from_world_translation)};
}

CameraPose Inverse(const CameraPose& pose) { return {pose.camera_from_world_rotation.transpose(), CentreOf(pose)}; }

Vector3d MovedPoint(const CameraPose& target_from_source, const Vector3d& point_in_source) {
  return target_from_source.camera_from_world_rotation * point_in_source +
         target_from_source.camera_from_world_translation;
}

MatrixX3d MovedPoints(const CameraPose& target_from_source, const MatrixX3d& points_in_source) {
  return (points_in_source * target_from_source.camera_from_world_rotation.transpose()).rowwise() +
         target_from_source.camera_from_world_translation.transpose();
}

Vector3d CentreOf(const CameraPose& camera_from_world) {
  return -(camera_from_world.camera_from_world_rotation.transpose() * camera_from_world.camera_from_world_translation);
}

CameraPose InterpolatePoses(const CameraPose& a, const CameraPose& b, double s) {
  // Interpolating translations of rotating cameras would bend the path of the centre.
  CameraPose pose;
  pose.camera_from_world_rotation = InterpolateRotation(a.camera_from_world_rotation, b.camera_from_world_rotation, s);
  const Vector3d centre = (1 - s) * CentreOf(a) + s * CentreOf(b);
  pose.camera_from_world_translation = -pose.camera_from_world_rotation * centre;
  return pose;
}

BodyPose MovedPose(const CameraPose& target_from_source, const Vector3d& rest_pelvis, BodyPose pose) {
  pose.rotations[0] = target_from_source.camera_from_world_rotation * pose.rotations[0];
  pose.trans = MovedPoint(target_from_source, rest_pelvis + pose.trans) - rest_pelvis;
  return pose;
}

Motion MovedMotion(const BodyModel& body, const Motion& motion, std::span<const CameraPose> target_from_source) {
  const auto T = static_cast<size_t>(motion.num_frames());
  BODYLOOM_CHECK(target_from_source.size() == 1 || target_from_source.size() == T,
                 "moved motion: ", target_from_source.size(), " rigid motions for ", T, " frames");
  Motion moved = motion;
  const Vector3d pelvis = body.RestJoints(motion.betas).row(0).transpose();
  const Vector3d mean = body.data().pose_mean.size() > 0 ? Vector3d(body.data().pose_mean.head<3>()) : Vector3d::Zero();
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (!motion.HasPose(t)) continue;
    const CameraPose& move = target_from_source[target_from_source.size() == 1 ? 0 : size_t(t)];
    const Vector3d root = motion.poses.row(t).head<3>().transpose();
    moved.poses.row(t).head<3>() =
        (AxisAngleFromRotation(move.camera_from_world_rotation * RotationFromAxisAngle(root + mean)) - mean)
            .transpose();
    const Vector3d trans = motion.trans.row(t).transpose();
    moved.trans.row(t) = (MovedPoint(move, pelvis + trans) - pelvis).transpose();
  }
  return moved;
}

SampledCameraPath SampleCameraPath(const CameraPath& path, std::span<const double> timestamps,
                                   const CameraPathLimits& limits) {
  CheckPath(path);
  SampledCameraPath sampled;
  const CameraPose scene_from_world = path.poses.front(), world_from_scene = Inverse(scene_from_world);
  const std::vector<double>& known = path.timestamps;
  for (const double t : timestamps) {
    const double before = known.front() - t, after = t - known.back();
    BODYLOOM_CHECK(std::max(before, after) <= limits.max_beyond_s, "camera path: nothing is known of the camera at ", t,
                   " s; its path goes from ", known.front(), " to ", known.back(), " s, and at most ",
                   limits.max_beyond_s, " s beyond are taken to stand still");
    CameraPose pose;
    if (before >= 0 || after >= 0) {
      pose = before >= 0 ? path.poses.front() : path.poses.back();
      if (std::max(before, after) > kSameMomentS) ++sampled.beyond;
    } else {
      const auto next = static_cast<size_t>(std::upper_bound(known.begin(), known.end(), t) - known.begin());
      const double t0 = known[next - 1], t1 = known[next];
      pose = InterpolatePoses(path.poses[next - 1], path.poses[next], (t - t0) / (t1 - t0));
      const bool is_known = std::min(t - t0, t1 - t) <= kSameMomentS;
      BODYLOOM_CHECK(is_known || t1 - t0 <= limits.max_gap_s, "camera path: nothing is known of the camera from ", t0,
                     " to ", t1, " s; at most ", limits.max_gap_s, " s are bridged");
      if (!is_known) ++sampled.interpolated;
    }
    sampled.camera_from_scene.push_back(Compose(pose, world_from_scene));
  }
  return sampled;
}

std::vector<CameraPose> ScaledPath(std::span<const CameraPose> camera_from_scene, double scale) {
  std::vector<CameraPose> scaled(camera_from_scene.begin(), camera_from_scene.end());
  for (CameraPose& pose : scaled) pose.camera_from_world_translation *= scale;
  return scaled;
}

Track TrackInCameras(const BodyModel& body, const Track& track) {
  Track seen = track;
  if (track.camera_from_scene.empty()) return seen;
  seen.motion = MovedMotion(body, track.motion, track.camera_from_scene);
  for (auto* points : {&seen.joints, &seen.coco17}) {
    for (size_t t = 0; t < points->size(); ++t) (*points)[t] = MovedPoints(track.camera_from_scene[t], (*points)[t]);
  }
  seen.camera_from_scene.clear();
  seen.world.reset();
  seen.level_m.resize(0);
  return seen;
}

}  // namespace bodyloom
