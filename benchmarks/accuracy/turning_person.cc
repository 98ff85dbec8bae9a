// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/turning_person.h"

#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/units.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDistance_m = 4;
constexpr int kPelvis = 0, kLeftShoulder = 16, kRightShoulder = 17, kLeftElbow = 18, kRightElbow = 19;

Matrix3d Turn(double x_deg, double y_deg, double z_deg) {
  return RotationFromAxisAngle(kDegree * Vector3d(x_deg, y_deg, z_deg));
}

BodyPose PoseAt(const BodyModel& body, double yaw_deg, double arms_deg) {
  BodyPose pose;
  pose.rotations.assign(body.num_joints(), Matrix3d::Identity());
  Matrix3d camera_from_world = Matrix3d::Identity();
  camera_from_world(1, 1) = camera_from_world(2, 2) = -1;
  pose.rotations[kPelvis] = camera_from_world * Turn(0, 0.4 * yaw_deg, 0);
  for (const int spine : {3, 6, 9}) pose.rotations[spine] = Turn(0, 0.2 * yaw_deg, 0);
  pose.rotations[kLeftShoulder] = Turn(0, 0, -arms_deg);
  pose.rotations[kRightShoulder] = Turn(0, 0, arms_deg);
  pose.rotations[kLeftElbow] = Turn(0, -25, 0);
  pose.rotations[kRightElbow] = Turn(0, 25, 0);
  pose.trans = Vector3d(0, 0, kDistance_m);
  return pose;
}

}  // namespace

TurningPerson MakeTurningPerson(const BodyModel& body, const TurningPersonOptions& o) {
  BODYLOOM_CHECK(body.num_joints() >= 24, "turning person: ", body.num_joints(), " joints, expected SMPL's 24");
  BODYLOOM_CHECK(o.cycles > 0 && o.period_s > 0 && o.fps > 0 && o.image_size > 0, "turning person: nothing to make");
  BODYLOOM_CHECK(o.variation >= 0 && o.variation < 1 && o.pose_noise_deg >= 0, "turning person: variation ",
                 o.variation, ", noise ", o.pose_noise_deg);
  TurningPerson person;
  std::vector<Eigen::VectorXd> poses;
  // Turning points: when, where, and how the arms hang then.
  double from_s = 0;
  const auto vary = [&](int half, uint64_t what) {
    return o.variation * HashRandom(o.seed, {what, uint64_t(half)}).Uniform(-1, 1);
  };
  const auto end_deg = [&](int half) { return (half % 2 == 0 ? 1 : -1) * o.amplitude_deg * (1 + vary(half, 1)); };
  const auto arms_deg = [&](int half) { return 65 + 40 * vary(half, 2); };
  for (int half = 0; half < 2 * (o.cycles + 1); ++half) {
    const double length_s = 0.5 * o.period_s * (1 + vary(half, 3));
    for (int t = static_cast<int>(poses.size()); t / o.fps < from_s + length_s; ++t) {
      const double phase = (t / o.fps - from_s) / length_s, carry = 0.5 - 0.5 * std::cos(M_PI * phase);
      const double turn_deg = end_deg(half + 1) - end_deg(half);
      person.cycle.push_back(half / 2 - 1);
      person.yaw_deg.push_back(end_deg(half) + carry * turn_deg);
      person.yaw_rate_deg_s.push_back(turn_deg * 0.5 * M_PI / length_s * std::sin(M_PI * phase));
      BodyPose pose =
          PoseAt(body, person.yaw_deg.back(), arms_deg(half) + carry * (arms_deg(half + 1) - arms_deg(half)));
      HashRandom noise(o.seed, {4, uint64_t(t)});
      for (Matrix3d& rotation : pose.rotations) {
        const double z = noise.Normal(), y = noise.Normal(), x = noise.Normal();
        rotation = rotation * RotationFromAxisAngle(o.pose_noise_deg * kDegree * Vector3d(x, y, z));
      }
      poses.push_back(AxisAngleFromPose(body, pose));
    }
    from_s += length_s;
  }
  const auto num_frames = static_cast<Eigen::Index>(poses.size());
  Track& track = person.track;
  track.camera = MakePinhole(o.image_size, o.image_size, 1.8 * o.image_size);
  track.motion.body = body.name();
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses.resize(num_frames, 3 * body.num_joints());
  track.motion.trans = MatrixX3d::Zero(num_frames, 3);
  track.motion.trans.col(2).setConstant(kDistance_m);
  for (Eigen::Index t = 0; t < num_frames; ++t) {
    track.motion.poses.row(t) = poses[t].transpose();
    track.motion.timestamps.push_back(double(t) / o.fps);
  }
  track.frame_status.assign(poses.size(), FrameStatus::kTracked);
  return person;
}

}  // namespace bodyloom
