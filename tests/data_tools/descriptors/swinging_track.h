// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom {

/// A clip in which every joint swings and the body walks and turns.
inline Track Swinging(int T, double fps = 30) {
  const BodyModel& body = ToyBody();
  Track track;
  track.camera = MakePinhole(96, 96, 110);
  track.motion.body = "toy";
  track.motion.poses.resize(T, 72);
  track.motion.trans.resize(T, 3);
  track.motion.up = Motion::Up::kCamera;
  const Eigen::VectorXd centre = RandomAxisAngle(body, 3, 0.6), swing = RandomAxisAngle(body, 4, 0.5);
  for (int t = 0; t < T; ++t) {
    const double time = t / fps;
    track.motion.timestamps.push_back(time);
    Eigen::VectorXd pose = centre;
    for (Eigen::Index i = 3; i < pose.size(); ++i) pose[i] += swing[i] * std::sin(5 * time + static_cast<double>(i));
    pose.head<3>() = AxisAngleFromRotation(RotationFromAxisAngle(Eigen::Vector3d(0, 2 * time, 0)) *
                                           RotationFromAxisAngle(centre.head<3>()));
    track.motion.poses.row(t) = pose.transpose();
    track.motion.trans.row(t) << std::sin(2 * time), 0.1 * std::cos(3 * time), 2.5 + 0.4 * time;
  }
  track.frame_status.assign(T, FrameStatus::kTracked);
  return track;
}

}  // namespace bodyloom
