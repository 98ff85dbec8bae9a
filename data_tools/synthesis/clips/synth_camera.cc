// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/synth_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kShakeTimeConstant_s = 0.6, kFollowBlur_s = 0.5;
constexpr uint64_t kShakeStream = 301;

const std::array<const char*, 4> kSynthCameraMotionNames = {"still", "hand-held", "walking", "orbit"};

/// The pelvis over the ground, averaged over about a second: T×3, without its height.
MatrixX3d SmoothGroundTrack(const MatrixX3d& pelvis, const Vector3d& up, const std::vector<double>& times) {
  MatrixX3d smooth = MatrixX3d::Zero(pelvis.rows(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::pair<double, double>> keys;
    for (Eigen::Index t = 0; t < pelvis.rows(); ++t) keys.emplace_back(times[size_t(t)], pelvis(t, axis));
    const SmoothCurve curve(keys, kFollowBlur_s);
    for (Eigen::Index t = 0; t < pelvis.rows(); ++t) smooth(t, axis) = curve(times[size_t(t)]);
  }
  for (Eigen::Index t = 0; t < smooth.rows(); ++t) {
    const Vector3d row = smooth.row(t).transpose();
    smooth.row(t) = (row - up.dot(row) * up).transpose();
  }
  return smooth;
}

/// Small rigid motions of the camera in its own frame.
std::vector<CameraPose> Shakes(const std::vector<double>& times, const SynthCameraPathOptions& options, uint64_t seed) {
  std::array<std::vector<double>, 6> drift;
  for (size_t k = 0; k < drift.size(); ++k) {
    drift[k] = SmoothDrift(times, kShakeTimeConstant_s, HashRandom(seed, {kShakeStream, uint64_t{k}}));
  }
  std::vector<CameraPose> shakes(times.size());
  for (size_t t = 0; t < times.size(); ++t) {
    const Vector3d turn = options.shake_deg * kDegree * Vector3d(drift[0][t], drift[1][t], drift[2][t]);
    shakes[t].camera_from_world_rotation = RotationFromAxisAngle(turn);
    shakes[t].camera_from_world_translation = options.shake_m * Vector3d(drift[3][t], drift[4][t], drift[5][t]);
  }
  return shakes;
}

CameraPose Shifted(const Vector3d& by) { return {Matrix3d::Identity(), by}; }
using Eigen::Vector2d;

/// Rotation that takes the motion's world to one with y up.
Matrix3d YUpFromWorld(Motion::Up up) {
  switch (up) {
    case Motion::Up::kY:
      return Matrix3d::Identity();
    case Motion::Up::kZ:
      return RotationFromAxisAngle(Vector3d(-M_PI / 2, 0, 0));
    case Motion::Up::kCamera:
      return RotationFromAxisAngle(Vector3d(M_PI, 0, 0));
  }
  return Matrix3d::Identity();
}

/// A few hundred vertices of every frame, enough to determine the extent of the clip.
std::vector<Vector3d> SampleSurface(const BodyModel& body, const Motion& motion) {
  std::vector<int> vertices;
  for (int v = 0; v < body.num_vertices(); v += std::max(1, body.num_vertices() / 300)) vertices.push_back(v);
  std::vector<Vector3d> points;
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (!motion.HasPose(t)) continue;
    const BodyPose pose = PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    const MatrixX3d frame = PoseVertices(body, motion.betas, pose, vertices);
    for (int i = 0; i < frame.rows(); ++i) points.push_back(frame.row(i).transpose());
  }
  return points;
}

}  // namespace

bool SynthCameraOptions::IsValid(std::string* why) const {
  const auto no = [&](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (width < 16 || height < 16 || width > 16384 || height > 16384)
    return no("synth camera: size must be 16 to 16384 px a side");
  if (!(focal_px >= 0 && std::isfinite(focal_px))) return no("synth camera: focal_px must be positive, or 0");
  if (!(std::abs(elevation_deg) <= 85)) return no("synth camera: elevation_deg must be in [-85, 85]");
  if (!std::isfinite(yaw_deg)) return no("synth camera: yaw_deg must be finite");
  if (!(fill > 0.02 && fill <= 1)) return no("synth camera: fill must be in (0.02, 1]");
  return true;
}

SynthCamera PlaceSynthCamera(const BodyModel& body, const Motion& motion, const SynthCameraOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  SynthCamera result;
  const double focal_px = options.focal_px > 0 ? options.focal_px : 1.1 * std::max(options.width, options.height);
  result.camera = MakePinhole(options.width, options.height, focal_px);
  result.camera.distortion = options.distortion;
  result.camera.model = options.model;

  // World → y up → turned so that the camera stands on +z → y down, z away → tilted.
  const Matrix3d look = RotationFromAxisAngle(Vector3d(M_PI, 0, 0));
  const Matrix3d R = RotationFromAxisAngle(Vector3d(options.elevation_deg * kDegree, 0, 0)) * look *
                     RotationFromAxisAngle(Vector3d(0, -options.yaw_deg * kDegree, 0)) * YUpFromWorld(motion.up);
  std::vector<Vector3d> points = SampleSurface(body, motion);
  BODYLOOM_CHECK(!points.empty(), "synth camera: the motion has no finite frame");
  for (Vector3d& x : points) x = R * x;

  // Distance and lateral shift depend on each other: a few iterations of centring the image and minimising the
  // distance.
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : points) box.extend(x);
  Vector3d centre = box.center();
  const double half_w = 0.5 * options.fill * options.width, half_h = 0.5 * options.fill * options.height;
  double distance = 0;
  if (options.model == CameraModel::kWeakPerspective) {
    const Vector3d half = 0.5 * box.sizes();
    result.camera.scale = std::min(half_w / std::max(half.x(), 1e-6), half_h / std::max(half.y(), 1e-6));
    distance = 5;  // does not show, but puts the body in front of the camera
  } else {
    for (int round = 0; round < 12; ++round) {
      // Without distortion a point at depth z + d is seen at f·x/(z + d).
      distance = 0;
      for (const Vector3d& x : points) {
        const Vector3d r = x - centre;
        distance = std::max({distance, focal_px * std::abs(r.x()) / half_w - r.z(),
                             focal_px * std::abs(r.y()) / half_h - r.z(), 0.3 - r.z()});
      }
      Eigen::AlignedBox2d seen;
      for (const Vector3d& x : points) {
        const Vector3d r = x - centre;
        seen.extend(Vector2d(r.x(), r.y()) / (r.z() + distance));
      }
      centre.head<2>() += 0.7 * distance * seen.center();
    }
  }
  result.up_in_camera = R * YUpFromWorld(motion.up).transpose() * Vector3d::UnitY();
  result.pose.camera_from_world_rotation = R;
  result.pose.camera_from_world_translation = Vector3d(0, 0, distance) - centre;
  return result;
}

Motion MotionInCamera(const BodyModel& body, const Motion& motion, const CameraPose& pose) {
  Motion result = MovedMotion(body, motion, {&pose, 1});
  result.up = Motion::Up::kCamera;
  return result;
}

std::string ToString(SynthCameraMotion motion) { return kSynthCameraMotionNames[size_t(motion)]; }

SynthCameraMotion SynthCameraMotionFromString(const std::string& text) {
  const auto* const found = std::find(kSynthCameraMotionNames.begin(), kSynthCameraMotionNames.end(), text);
  BODYLOOM_CHECK(found != kSynthCameraMotionNames.end(), "camera motion '", text,
                 "', expected still, hand-held, walking or orbit");
  return static_cast<SynthCameraMotion>(found - kSynthCameraMotionNames.begin());
}

bool SynthCameraPathOptions::IsValid(std::string* why) const {
  const auto no = [&](const std::string& text) {
    if (why != nullptr) *why = "synth camera path: " + text;
    return false;
  };
  if (!(shake_deg >= 0 && shake_deg <= 30)) return no("shake_deg must be in [0, 30]");
  if (!(shake_m >= 0 && shake_m <= 2)) return no("shake_m must be in [0, 2]");
  if (!(std::abs(orbit_deg) <= 720)) return no("orbit_deg must be in [-720, 720]");
  return true;
}

SynthCameraPath MakeSynthCameraPath(const BodyModel& body, const Motion& motion, const SynthCameraOptions& camera,
                                    const SynthCameraPathOptions& path, uint64_t seed) {
  std::string why;
  BODYLOOM_CHECK(path.IsValid(&why), why);
  SynthCameraPath result;
  if (path.motion == SynthCameraMotion::kStill) {
    result.first = PlaceSynthCamera(body, motion, camera);
    return result;
  }
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole, "synth camera path: a camera that moves is a pinhole's");
  const int T = motion.num_frames();
  const Vector3d rest_pelvis = body.RestJoints(motion.betas).row(0).transpose();
  const MatrixX3d pelvis = motion.trans.rowwise() + rest_pelvis.transpose();
  const Vector3d up = motion.up == Motion::Up::kZ   ? Vector3d(0, 0, 1)
                      : motion.up == Motion::Up::kY ? Vector3d(0, 1, 0)
                                                    : Vector3d(0, -1, 0);
  const bool follows = path.motion != SynthCameraMotion::kHandHeld;
  const MatrixX3d way = SmoothGroundTrack(pelvis, up, motion.timestamps);
  Motion in_place = motion;
  if (follows) in_place.trans -= way;
  result.first = PlaceSynthCamera(body, in_place, camera);
  const std::vector<CameraPose> shakes = Shakes(motion.timestamps, path, seed);
  std::vector<CameraPose> camera_from_world;
  for (int t = 0; t < T; ++t) {
    CameraPose pose = result.first.pose;
    if (path.motion == SynthCameraMotion::kOrbit) {
      const Vector3d centre = in_place.trans.row(t).transpose() + rest_pelvis;
      const double at = T > 1 ? SmoothStep(double(t) / (T - 1)) : 0;
      const CameraPose turn{RotationFromAxisAngle(-path.orbit_deg * kDegree * at * up), Vector3d::Zero()};
      const Vector3d axis = centre - up.dot(centre) * up;
      pose = Compose(Compose(Compose(pose, Shifted(axis)), turn), Shifted(-axis));
    }
    if (follows) pose = Compose(pose, Shifted(-way.row(t).transpose()));
    camera_from_world.push_back(Compose(shakes[size_t(t)], pose));
  }
  result.first.pose = camera_from_world.front();
  const CameraPose world_from_scene = Inverse(camera_from_world.front());
  for (const CameraPose& pose : camera_from_world) result.camera_from_scene.push_back(Compose(pose, world_from_scene));
  result.first.up_in_camera = result.first.pose.camera_from_world_rotation * up;
  return result;
}

}  // namespace bodyloom
