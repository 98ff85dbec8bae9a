// SPDX-License-Identifier: Apache-2.0
/// States of a live run, and a detector that knows the truth, for tests.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/math/rotation.h"
#include "pipelines/live/live_state.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom {

/// The toy body in a random pose 3 m before the camera; lost where `pose` is null.
inline LiveState ToyState(int64_t index, bool lost = false) {
  LiveState state;
  state.body = std::make_shared<const BodyModel>(ToyBodyData());
  state.frame.index = index;
  state.frame.timestamp = double(index) / 30;
  state.frame.status = lost ? FrameStatus::kLost : FrameStatus::kTracked;
  state.frame.betas = Eigen::VectorXd::Zero(6);
  state.frame.joint_sigma = Eigen::VectorXd::Constant(24, 0.02);
  state.frame.camera = MakePinhole(640, 480, 600);
  state.rest_joints = state.body->RestJoints(state.frame.betas);
  if (!lost) {
    state.pose = RandomPose(*state.body, uint32_t(index), 0.5, 3);
    state.joints = PoseSkeleton(*state.body, state.rest_joints, state.pose).joints;
  }
  state.world = WorldOverGround({0, -1, 0}, 1.5);
  state.delay_ms = 99.96;
  state.dropped = 3;
  return state;
}

/// The toy body that waves and sways; frame t of a clip of 30 frames a second.
inline std::vector<Keypoint> WavingLandmarks(int t, int width, int height) {
  Eigen::VectorXd axis_angle = RandomAxisAngle(ToyBody(), 5, 0.3);
  axis_angle[3 * 16 + 2] = 0.8 * std::sin(0.1 * t);
  axis_angle[3 * 17 + 2] = 0.8 * std::cos(0.1 * t);
  const Eigen::Vector3d pelvis = ToyBody().joint_template().row(0).transpose();
  const BodyPose pose =
      PoseFromAxisAngle(ToyBody(), axis_angle, Eigen::Vector3d(0.1 * std::sin(0.05 * t), 0, 4) - pelvis);
  const MatrixX3d points = PoseLandmarks(ToyBody(), Eigen::VectorXd(), pose, Coco17().names);
  const Camera camera = MakePinhole(width, height, 1.2 * width);
  std::vector<Keypoint> landmarks;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    Eigen::Vector2d pixel;
    camera.Project(points.row(k).transpose(), &pixel);
    landmarks.push_back({float(pixel.x()), float(pixel.y()), 0.9F});
  }
  return landmarks;
}

/// Finds the waving body in whatever it is shown: WavingLandmarks() of its count of frames.
class KnowingDetector : public FrameDetector {
 public:
  [[nodiscard]] const KeypointConvention& convention() const override { return Coco17(); }
  std::vector<std::vector<FramePerson>> Detect(std::span<const Image> frames,
                                               std::span<const FrameParts> /*parts*/) override {
    std::vector<std::vector<FramePerson>> people(frames.size());
    for (size_t i = 0; i < frames.size(); ++i) {
      FramePerson& person = people[i].emplace_back();
      person.person.points = WavingLandmarks(count_++, frames[i].width, frames[i].height);
    }
    return people;
  }
  [[nodiscard]] PeopleDetectorSummary summary() const override { return {}; }

 private:
  int count_ = 0;
};

}  // namespace bodyloom
