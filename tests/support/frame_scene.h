// SPDX-License-Identifier: Apache-2.0
/// A scene of one frame of a toy body before a camera, with the inputs of the frame cost; tests of its terms add
/// observations.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "geometry/math/rotation.h"
#include "geometry/scene/observations.h"
#include "tests/support/toy_body.h"
#include "tracking/problem/frame_cost.h"

namespace bodyloom {

/// Points into itself (data, layout): not to be copied.
struct FrameScene : SharedValues {
  BodyModel body;
  FrameLayout layout;
  FrameData data;
  FrameState state;
  std::vector<DenseKeypoint> dense;
  explicit FrameScene(const BodyModelData& data = ToyBodyData()) : body(data) {}
  FrameScene(const FrameScene&) = delete;
  FrameScene& operator=(const FrameScene&) = delete;
};

/// A non-owning pointer, for terms that share data of a scene.
template <typename T>
std::shared_ptr<const T> Borrowed(const T& value) {
  return {std::shared_ptr<void>(), &value};
}

inline std::vector<int> AllJoints(const BodyModel& body) {
  std::vector<int> all;
  for (int j = 0; j < body.num_joints(); ++j) all.push_back(j);
  return all;
}

/// A rotation vector of independent normal numbers of this size.
inline Eigen::Vector3d RandomTurn(double radians, std::mt19937_64* random) {
  std::normal_distribution<double> normal;
  const double x = normal(*random), y = normal(*random), z = normal(*random);
  return radians * Eigen::Vector3d(x, y, z);
}

/// Layout (distorted when the camera is known), shape and focal length; the joints in `active` are unknowns.
inline void PlaceCamera(CameraKnowledge knowledge, Camera camera, double focal_px, const std::vector<int>& active,
                        std::mt19937_64* random, FrameScene* scene) {
  std::normal_distribution<double> normal;
  if (knowledge == CameraKnowledge::kKnown) camera.distortion = {-0.12, 0.03, 0.001, -0.002, 0.004, 0.01, 0, 0};
  scene->layout = FrameLayout::Make(scene->body, knowledge, camera, active, scene->body.num_betas());
  scene->betas = Eigen::VectorXd::NullaryExpr(scene->body.num_betas(), [&]() { return 0.5 * normal(*random); });
  scene->log_focal = std::log(focal_px);
}

/// Random rotations of this size, a few metres before the camera; after PlaceCamera().
inline void PoseAtRandom(CameraKnowledge knowledge, double pose_size, std::mt19937_64* random, FrameScene* scene) {
  for (int j = 0; j < scene->body.num_joints(); ++j) {
    scene->state.rotations.push_back(RotationFromAxisAngle(RandomTurn(pose_size, random)));
  }
  scene->state.translation = knowledge == CameraKnowledge::kWeak ? Eigen::Vector3d(std::log(250.0), 0.1, -0.2)
                                                                 : Eigen::Vector3d(0.2, -0.1, 4.0);
}

inline FrameSystem Evaluate(const FrameScene& scene, bool derivatives = true) {
  FrameEvaluator evaluator;
  FrameSystem system;
  evaluator.Evaluate(scene.layout, scene.data, scene.state, scene, derivatives, &system);
  return system;
}

/// A frame's cost against its twin's (cost, and the robustly weighted residual r with its derivatives J, by automatic
/// differentiation): cost, gradient and Gauss–Newton matrix to 1e-9 relative.
inline void ExpectMatchesTwin(const FrameSystem& system, double cost, const Eigen::MatrixXd& J,
                              const Eigen::VectorXd& r) {
  constexpr double kRelative = 1e-9;
  EXPECT_NEAR(system.cost, cost, kRelative * std::max(cost, 1e-6));
  // Rounding in r propagates through J: at a zero residual the gradient is zero to 1e-12 of that of a unit residual.
  const Eigen::VectorXd gradient = J.transpose() * r;
  EXPECT_LE((system.gradient - gradient).norm(), kRelative * gradient.norm() + 1e-12 * J.norm());
  const Eigen::MatrixXd H = system.H.selfadjointView<Eigen::Lower>(), expected = J.transpose() * J;
  ASSERT_TRUE(H.allFinite());
  EXPECT_LE((H - expected).norm(), kRelative * std::max(1e-3, expected.norm()));
}

}  // namespace bodyloom
