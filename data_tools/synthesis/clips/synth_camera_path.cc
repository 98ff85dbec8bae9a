// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/synth_camera_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "data_tools/synthesis/clips/smooth_curve.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/units.h"
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

}  // namespace

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
