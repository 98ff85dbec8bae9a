// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "data_tools/synthesis/lifter/fast_random.h"

namespace bodyloom {

using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {

constexpr float kContactHeight = 0.04F, kContactSpeed = 0.35F, kContactSpeedWithoutFloor = 0.25F;
constexpr double kLowestElevation = -35, kHighestElevation = 75;  // degrees, of LifterWindowOptions::any_elevation
constexpr float kMinDepth = 0.9F;                                 // of the nearest landmark, metres for the mean body

Vector3f MidHip(const Vector3f* points) { return 0.5F * (points[kLifterLeftHip] + points[kLifterLeftHip + 1]); }

}  // namespace

WorldMotion PoseInWorld(const LifterBody& body, const LifterPerson& person, const PoseSequence& poses, double rate) {
  const int T = poses.num_frames;
  WorldMotion motion;
  motion.points.resize(static_cast<size_t>(T) * kLifterPoints);
  motion.detected.resize(motion.points.size());
  motion.contact.assign(2 * static_cast<size_t>(T), 0);
  std::vector<float> floor(T);
  PosedPerson posed;
  for (int t = 0; t < T; ++t) {
    body.Pose(person, &poses.at(t, 0), person.size * poses.trans[t], &posed);
    const float lowest = body.Lowest(person, posed);
    const float lift = poses.has_floor ? person.size * poses.clearance[t] - lowest : 0;
    floor[t] = poses.has_floor ? 0 : lowest;
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = static_cast<size_t>(t) * kLifterPoints + k;
      motion.points[i] = posed.point[k] + Vector3f(0, lift, 0);
      motion.detected[i] = body.DetectedPoint(person, posed, k) + Vector3f(0, lift, 0);
    }
  }
  const auto radius = body.foot_radius();
  const float max_speed = poses.has_floor ? kContactSpeed : kContactSpeedWithoutFloor;
  for (int t = 0; t < T; ++t) {
    const int before = std::max(0, t - 1), after = std::min(T - 1, t + 1);
    const float seconds = static_cast<float>((after - before) / rate);
    for (int side = 0; side < 2; ++side) {
      for (int end = 0; end < 2; ++end) {
        const int k = (end == 0 ? kLifterLeftBigToe : kLifterLeftHeel) + side;
        const auto at = [&](int frame) { return motion.points[static_cast<size_t>(frame) * kLifterPoints + k]; };
        const float height = at(t).y() / person.size - floor[t] / person.size - radius[end];
        const float speed = seconds > 0 ? (at(after) - at(before)).norm() / seconds / person.size : 0;
        if (height < kContactHeight && speed < max_speed) motion.contact[2 * static_cast<size_t>(t) + side] = 1;
      }
    }
  }
  return motion;
}

LifterScene FilmPerson(const WorldMotion& motion, const LifterPerson& person, const LifterWindowOptions& options,
                       HashRandom random) {
  const int T = static_cast<int>(motion.points.size()) / kLifterPoints;
  const auto radian = [](double degrees) { return static_cast<float>(degrees * M_PI / 180); };
  const float yaw = static_cast<float>(random.Uniform(0, 2 * M_PI));
  // Draws no random numbers when it is off, so that windows as recorded do not change.
  const bool anywhere = options.any_elevation > 0 && random.Uniform() < options.any_elevation;
  const float elevation = radian(anywhere ? random.Uniform(kLowestElevation, kHighestElevation)
                                          : random.Uniform(options.min_elevation_deg, options.max_elevation_deg));
  const float roll = radian(options.roll_sd_deg * random.Normal());
  const float distance =
      person.size *
      static_cast<float>(std::exp(random.Uniform(std::log(options.min_distance), std::log(options.max_distance))));
  const float aside = static_cast<float>(options.off_axis * random.Uniform(-1, 1));
  const float above = static_cast<float>(0.5 * options.off_axis * random.Uniform(-1, 1));
  const bool moves = random.Uniform() < options.moving_camera;

  // Rows: right, down and forward of a camera that looks at the person; it is turned off the person below.
  const Vector3f forward(-std::cos(elevation) * std::sin(yaw), -std::sin(elevation),
                         -std::cos(elevation) * std::cos(yaw));
  const Vector3f right = forward.cross(Vector3f::UnitY()).normalized(), down = forward.cross(right);
  Matrix3f camera_from_world;
  camera_from_world << right.transpose(), down.transpose(), forward.transpose();
  camera_from_world = Eigen::AngleAxisf(roll, Vector3f::UnitZ()).toRotationMatrix() * camera_from_world;

  Vector3f middle = Vector3f::Zero();
  for (int t = 0; t < T; ++t) middle += MidHip(&motion.points[static_cast<size_t>(t) * kLifterPoints]);
  middle /= static_cast<float>(T);
  Vector3f place = distance * Vector3f(aside, above, 1);  // of the middle, in the camera
  // Moves back until no point is too near and the hips are within 45° of the axis, as in a composed shot.
  float missing = 0;
  for (const Vector3f& p : motion.points) {
    missing = std::max(missing, kMinDepth * person.size - place.z() - camera_from_world.row(2).dot(p - middle));
  }
  for (int t = 0; t < T; ++t) {
    const Vector3f hip =
        camera_from_world * (MidHip(&motion.points[static_cast<size_t>(t) * kLifterPoints]) - middle) + place;
    missing = std::max(missing, hip.head<2>().cwiseAbs().maxCoeff() - hip.z());
  }
  place.z() += missing;

  LifterScene scene;
  scene.num_frames = T;
  scene.points.resize(motion.points.size());
  scene.detected.resize(motion.points.size());
  scene.up.resize(T);
  scene.contact = motion.contact;
  scene.reference_length = person.reference_length;
  scene.size = person.size;
  FastNormal normal(random);
  std::vector<float> shake[3];
  if (moves) {
    for (auto& s : shake) SmoothNoise(T, static_cast<float>(0.4 * options.rate), &normal, &s);
  }
  Vector3f followed = Vector3f::Zero();
  for (int t = 0; t < T; ++t) {
    Matrix3f turned = Matrix3f::Identity();
    if (moves) {
      // Follows the person with a delay of half a second, with a shake of half a degree.
      const Vector3f hip =
          camera_from_world * (MidHip(&motion.points[static_cast<size_t>(t) * kLifterPoints]) - middle) + place;
      followed =
          t == 0 ? hip : Vector3f(followed + (hip - followed) * std::min(1.0F, static_cast<float>(2 / options.rate)));
      turned = Eigen::Quaternionf::FromTwoVectors(followed, place).toRotationMatrix() *
               TurnBy(0.009F * Vector3f(shake[0][t], shake[1][t], shake[2][t])).toRotationMatrix();
    }
    const Matrix3f R = turned * camera_from_world;
    const Vector3f offset = turned * place;
    scene.up[t] = R.col(1);
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = static_cast<size_t>(t) * kLifterPoints + k;
      scene.points[i] = R * (motion.points[i] - middle) + offset;
      scene.detected[i] = R * (motion.detected[i] - middle) + offset;
    }
  }
  return scene;
}

}  // namespace bodyloom
