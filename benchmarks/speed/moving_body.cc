// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/speed/moving_body.h"

#include <cmath>
#include <random>

#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Vector3d;

BodyPose PoseAt(const BodyModel& body, double time, double hz) {
  BodyPose pose;
  for (int j = 0; j < body.num_joints(); ++j) {
    const Vector3d phase(0.7 * j, 1.9 * j, 2.3 * j);
    const Vector3d swing = (j == 0 ? 0.15 : 0.25) * (2 * M_PI * hz * time + phase.array()).sin();
    pose.rotations.push_back(RotationFromAxisAngle(swing));
  }
  pose.rotations[0] = RotationFromAxisAngle(Vector3d(M_PI, 0, 0)) * RotationFromAxisAngle(Vector3d(0, 0.8 * time, 0)) *
                      pose.rotations[0];
  pose.trans = Vector3d(0.3 * std::sin(2 * M_PI * hz * time), 0.05 * std::cos(4 * time), 3.2 + 0.2 * std::sin(time));
  return pose;
}

Track TrackOf(const BodyModel& body, int T, double fps, double hz, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Track track;
  track.camera = MakePinhole(640, 640, 900);
  track.motion.poses.resize(T, 3 * body.num_joints());
  track.motion.trans.resize(T, 3);
  track.motion.up = Motion::Up::kCamera;
  for (int t = 0; t < T; ++t) {
    BodyPose pose = PoseAt(body, t / fps, hz);
    for (auto& R : pose.rotations) {
      R *= RotationFromAxisAngle(noise * Vector3d{normal(random), normal(random), normal(random)});
    }
    pose.trans += 0.3 * noise * Vector3d{normal(random), normal(random), normal(random)};
    track.motion.poses.row(t) = AxisAngleFromPose(body, pose).transpose();
    track.motion.trans.row(t) = pose.trans.transpose();
    track.motion.timestamps.push_back(t / fps);
  }
  track.frame_status.assign(T, FrameStatus::kTracked);
  return track;
}

}  // namespace bodyloom
