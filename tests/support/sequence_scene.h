// SPDX-License-Identifier: Apache-2.0
/// A short clip of the toy body as a SequenceProblem: smooth motion, landmarks and surface points with noise and
/// outliers, and inexact initial values.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "geometry/math/rotation.h"
#include "tests/support/frame_scene.h"
#include "tests/support/toy_body.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/initialiser.h"
#include "tracking/terms/joint_limits.h"
#include "tracking/terms/landmarks.h"
#include "tracking/terms/straight_knees.h"
#include "tracking/terms/upright.h"

namespace bodyloom {

struct SequenceSceneOptions {
  int frames = 6;
  CameraKnowledge knowledge = CameraKnowledge::kKnown;
  int dense = 40;             ///< surface points a frame
  double start_error = 0.08;  ///< radians, each joint
  double outliers = 0.05;
  uint64_t seed = 1;
};

/// Not copyable, as it holds pointers into itself.
struct SequenceScene {
  BodyModel body{ToyBodyData()};
  JointLimits limits = JointLimits::ForBody(body);
  std::vector<CompiledPoint> landmarks;
  std::vector<std::vector<DenseKeypoint>> dense;
  std::vector<FrameState> truth;
  Eigen::VectorXd betas;  ///< true ones
  SequenceProblem problem;
  SequenceScene() = default;
  SequenceScene(const SequenceScene&) = delete;
  SequenceScene& operator=(const SequenceScene&) = delete;
};

inline std::unique_ptr<SequenceScene> MakeSequenceScene(const SequenceSceneOptions& options) {
  auto scene = std::make_unique<SequenceScene>();
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  SequenceProblem& problem = scene->problem;
  const BodyModel& body = scene->body;
  const int J = body.num_joints(), B = body.num_betas();
  const double focal = 1000;
  problem.layout = FrameLayout::Make(body, options.knowledge, MakePinhole(1280, 720, focal), AllJoints(body), B);
  const Eigen::VectorXd betas = Eigen::VectorXd::NullaryExpr(B, [&]() { return 0.4 * normal(random); });
  scene->betas = betas;
  for (const Landmark& landmark : body.data().landmarks) {
    scene->landmarks.push_back(CompilePoint(body, landmark.vertices, landmark.weights, B));
  }
  std::vector<Eigen::Vector3d> from, to;
  for (int j = 0; j < J; ++j) {
    from.push_back(RandomTurn(0.25, &random));
    to.push_back(RandomTurn(0.25, &random));
  }
  scene->dense.resize(options.frames);
  std::uniform_int_distribution<int> face(0, body.num_faces() - 1);
  const double log_focal = std::log(focal);
  for (int t = 0; t < options.frames; ++t) {
    const double s = 0.5 - 0.5 * std::cos(0.4 * t);
    FrameState state;
    for (int j = 0; j < J; ++j) state.rotations.push_back(RotationFromAxisAngle((1 - s) * from[j] + s * to[j]));
    state.translation = options.knowledge == CameraKnowledge::kWeak ? Eigen::Vector3d(std::log(250.0), 0.1 * s, -0.2)
                                                                    : Eigen::Vector3d(0.2 * s, -0.1, 4 - 0.3 * s);
    scene->truth.push_back(state);
    Kinematics kinematics;
    kinematics.Set(body, betas, state.rotations, problem.layout.BodyTranslation(state), false);
    PointEvaluator points;
    PointEvaluator::VertexCache cache;
    cache.NewFrame(kinematics);
    const Camera camera = problem.layout.CameraAt(state, log_focal);
    const auto see = [&](const Eigen::Vector3d& x, Eigen::Vector2d* pixel) {
      if (!camera.Project(x, pixel, nullptr)) return false;
      *pixel += 2 * Eigen::Vector2d{normal(random), normal(random)};
      if (unit(random) < options.outliers) *pixel += 60 * Eigen::Vector2d{normal(random), normal(random)};
      return true;
    };
    FrameData frame;
    for (const CompiledPoint& point : scene->landmarks) {
      LandmarkObservation observation;
      observation.point = &point;
      observation.sigma_px = 4;
      if (see(points.Evaluate(kinematics, point, false), &observation.pixel))
        frame.Get<LandmarkTerm>().seen.push_back(observation);
    }
    for (int i = 0; i < options.dense; ++i) {
      DenseKeypoint keypoint;
      keypoint.face = face(random);
      keypoint.barycentric = Eigen::Vector3f{unit(random), unit(random), unit(random) + 0.1F};
      keypoint.barycentric /= keypoint.barycentric.sum();
      keypoint.sigma_px = 2;
      const Eigen::Vector3d barycentric = keypoint.barycentric.cast<double>();
      Eigen::Vector2d pixel;
      const auto corners = body.data().faces.row(keypoint.face);
      if (!see(points.Evaluate(kinematics, corners.data(), barycentric.data(), &cache, false), &pixel)) continue;
      keypoint.pixel = pixel.cast<float>();
      scene->dense[t].push_back(keypoint);
    }
    frame.Get<DenseTerm>().points = &scene->dense[t];
    frame.Get<JointLimitTerm>().limits = Borrowed(scene->limits);
    frame.Get<UprightTerm>().weight = 1;
    frame.Get<StraightKneesTerm>() = {FindKnees(body), 0.5};
    problem.timestamps.push_back(t / 25.0);
    problem.cut_before.push_back(0);
    for (int j = 0; j < J; ++j) {
      state.rotations[j] = state.rotations[j] * RotationFromAxisAngle(RandomTurn(options.start_error, &random));
    }
    problem.states.push_back(state);
    frame.Get<DenseTerm>().kernel = 12;
    frame.Get<InitialiserTerm>().rotations = state.rotations;  // for what few points leave undetermined
    frame.Get<InitialiserTerm>().translation = state.translation;
    frame.Get<InitialiserTerm>().weight = 0.1;
    problem.frames.push_back(frame);
  }
  problem.betas = Eigen::VectorXd::Zero(B);
  problem.log_focal = problem.log_focal_prior =
      options.knowledge == CameraKnowledge::kUnknownFocal ? log_focal + 0.1 : log_focal;
  return scene;
}

}  // namespace bodyloom
