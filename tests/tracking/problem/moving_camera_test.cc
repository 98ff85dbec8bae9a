// SPDX-License-Identifier: Apache-2.0
// A frame of a moving camera: the change of variables against the same frame of a static camera, its derivatives
// against central differences, and both engines on a clip.
#include "tracking/problem/moving_camera.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tests/support/frame_scene.h"
#include "tests/support/sequence_scene.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom::moving_camera_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

CameraPose RandomCamera(std::mt19937_64* random) {
  const Vector3d turn = RandomTurn(0.4, random);
  return {RotationFromAxisAngle(turn), 0.5 * RandomTurn(1, random)};
}

/// The state and shape after a step of all columns.
void Step(const FrameLayout& layout, const VectorXd& step, FrameState* state, VectorXd* betas, double* log_focal) {
  for (const int j : layout.active_joints) {
    state->rotations[j] = state->rotations[j] * RotationFromAxisAngle(step.segment<3>(layout.column_of_joint[j]));
  }
  state->translation += step.segment<3>(layout.translation_column);
  *betas += step.segment(layout.beta_column, layout.num_betas);
  if (layout.focal_column >= 0) *log_focal += step[layout.focal_column];
}

FrameSystem EvaluateAt(const SequenceProblem& problem, const FrameData& data, const FrameState& state,
                       const VectorXd& betas, double log_focal) {
  FrameEvaluator evaluator;
  FrameSystem system;
  evaluator.Evaluate(problem.layout, data, state, SharedValues{betas, log_focal, {}}, true, &system);
  return system;
}

TEST(MovingCamera, AStateInTheCameraIsTheBodyMoved) {
  std::mt19937_64 random(1);
  const auto scene = MakeSequenceScene({.frames = 1});
  const CameraPose camera = RandomCamera(&random);
  const FrameState& state = scene->truth[0];
  const FrameState seen = StateInCamera(scene->problem.layout, camera, scene->betas, state);
  const MatrixX3d expected =
      MovedPoints(camera, PoseVertices(scene->body, scene->betas, {state.rotations, state.translation}));
  EXPECT_LT((PoseVertices(scene->body, scene->betas, {seen.rotations, seen.translation}) - expected).norm(), 1e-12);
  const FrameState back = StateInCamera(scene->problem.layout, Inverse(camera), scene->betas, seen);
  EXPECT_LT((back.translation - state.translation).norm(), 1e-13);
}

TEST(MovingCamera, CostAndDerivativesAreThoseOfTheSceneForAllTerms) {
  int checked = 0;
  for (const CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal}) {
    const auto scene = MakeSequenceScene({.frames = 2, .knowledge = knowledge, .seed = 7});
    std::mt19937_64 random(5);
    const SequenceProblem& problem = scene->problem;
    for (int t = 0; t < 2; ++t) {
      const CameraPose camera = RandomCamera(&random);
      FrameData data = problem.frames[t];
      const VectorXd betas = scene->betas;
      const FrameState seen = problem.states[t];  // what the observations are of
      const FrameState state = StateInCamera(problem.layout, Inverse(camera), betas, seen);
      const FrameSystem still = EvaluateAt(problem, data, seen, betas, problem.log_focal);
      data.camera_from_scene = &camera;
      const FrameSystem moving = EvaluateAt(problem, data, state, betas, problem.log_focal);
      EXPECT_NEAR(moving.cost, still.cost, 1e-10 * still.cost);
      ASSERT_GT(still.cost, 1);

      const int p = problem.layout.num_columns;
      const auto cost_after = [&](const VectorXd& step) {
        FrameState there = state;
        VectorXd shape = betas;
        double log_focal = problem.log_focal;
        Step(problem.layout, step, &there, &shape, &log_focal);
        return EvaluateAt(problem, data, there, shape, log_focal).cost;
      };
      const double h = 1e-5;
      for (int k = 0; k < p; ++k) {
        const VectorXd step = h * VectorXd::Unit(p, k);
        const double numeric = (cost_after(step) - cost_after(-step)) / (2 * h);
        EXPECT_NEAR(moving.gradient[k], numeric, 2e-6 * (1 + moving.gradient.norm())) << "column " << k;
        ++checked;
      }
      // The matrix: that of the still camera under the same change of variables, dense and column by column.
      MatrixXd T = MatrixXd::Identity(p, p);
      const Eigen::Matrix3d& R = camera.camera_from_world_rotation;
      const int at = problem.layout.translation_column;
      T.block<3, 3>(at, at) = R;
      T.block(at, problem.layout.beta_column, 3, problem.layout.num_betas) =
          (R - Eigen::Matrix3d::Identity()) * scene->body.joint_shapedirs().topRows(3);
      const MatrixXd H = still.H.selfadjointView<Eigen::Lower>();
      const MatrixXd expected = T.transpose() * H * T;
      const MatrixXd actual = moving.H.selfadjointView<Eigen::Lower>();
      EXPECT_LT((actual - expected).norm(), 1e-10 * expected.norm());
    }
  }
  EXPECT_GT(checked, 200);
}

/// The clip of a scene as cameras that move would have it: the same observations, states in the scene.
SequenceProblem SeenFrom(const SequenceProblem& problem, const std::vector<CameraPose>& cameras) {
  SequenceProblem moving = problem;
  for (size_t t = 0; t < cameras.size(); ++t) {
    moving.frames[t].camera_from_scene = &cameras[t];
    moving.states[t] = StateInCamera(problem.layout, Inverse(cameras[t]), problem.betas, problem.states[t]);
  }
  return moving;
}

TEST(MovingCamera, BothEnginesFindTheSameAnswer) {
  const auto scene = MakeSequenceScene({.frames = 8, .seed = 3});
  std::mt19937_64 random(11);
  std::vector<CameraPose> cameras;
  cameras.reserve(8);
  for (int t = 0; t < 8; ++t) cameras.push_back(RandomCamera(&random));
  std::array<double, 2> cost{};
  for (const SequenceSolver solver : {SequenceSolver::kChain, SequenceSolver::kCeres}) {
    SequenceProblem problem = SeenFrom(scene->problem, cameras);
    SolveOptions options;
    options.solver = solver;
    options.max_iterations = 200;
    options.function_tolerance = 1e-12;
    cost[solver == SequenceSolver::kCeres] = SolveSequence(&problem, options).final_cost;
  }
  EXPECT_NEAR(cost[0], cost[1], 1e-6 * cost[1]);
}

TEST(MovingCamera, ACameraThatStandsElsewhereAllTheTimeChangesNothing) {
  const auto scene = MakeSequenceScene({.frames = 6, .seed = 4});
  std::mt19937_64 random(2);
  const std::vector<CameraPose> cameras(6, RandomCamera(&random));
  SequenceProblem still = scene->problem, moving = SeenFrom(scene->problem, cameras);
  SolveOptions options;
  options.max_iterations = 200;
  options.function_tolerance = 1e-13;
  const double cost = SolveSequence(&still, options).final_cost;
  EXPECT_NEAR(SolveSequence(&moving, options).final_cost, cost, 1e-7 * cost);
  for (size_t t = 0; t < 6; ++t) {
    const FrameState seen = StateInCamera(moving, t);
    EXPECT_LT((seen.translation - still.states[t].translation).norm(), 1e-3);
    EXPECT_LT(RotationAngleBetween(seen.rotations[0], still.states[t].rotations[0]), 1e-3);
  }
}

}  // namespace
}  // namespace bodyloom::moving_camera_test
