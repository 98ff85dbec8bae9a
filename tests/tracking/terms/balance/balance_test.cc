// SPDX-License-Identifier: Apache-2.0
// Balance in the frame cost against automatic differentiation of its formula.
#include "tracking/terms/balance/balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/problem/robust.h"

namespace bodyloom::balance_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using twin::Jet;

struct Scene : FrameScene {
  std::vector<int> vertices;
  std::vector<double> weights;
  CompiledPoint centre;
};

/// A random pose; the "centre of mass" is a mixture of three vertices far apart, the supports are two others.
std::unique_ptr<Scene> MakeScene(CameraKnowledge knowledge, double sigma_m, uint64_t seed,
                                 std::vector<int> active = {}) {
  auto scene = std::make_unique<Scene>();
  std::mt19937_64 random(seed);
  if (active.empty()) active = AllJoints(scene->body);
  PlaceCamera(knowledge, MakePinhole(1280, 720, 1000), 1100, active, &random, scene.get());
  PoseAtRandom(knowledge, 0.5, &random, scene.get());
  const int V = scene->body.num_vertices();
  scene->vertices = {0, V / 3, V / 2};
  scene->weights = {0.5, 0.8, -0.3};
  scene->centre = CompilePoint(scene->body, scene->vertices, scene->weights, scene->body.num_betas());
  auto& term = scene->data.Get<BalanceTerm>();
  term.centre_of_mass = &scene->centre;
  term.vertices = {V / 4, V - 1};
  term.share = 0.3;
  term.offset_m = Vector3d(0.03, 0.01, -0.02);
  const Vector3d up = Vector3d(0.1, -0.9, -0.2).normalized();
  term.horizontal.row(0) = up.unitOrthogonal().transpose();
  term.horizontal.row(1) = up.cross(up.unitOrthogonal()).transpose();
  term.sigma_m = sigma_m;
  term.weight = 0.6;
  return scene;
}

void CheckAgainstTwin(const Scene& scene) {
  const auto& term = scene.data.Get<BalanceTerm>();
  MatrixXd J = MatrixXd::Zero(2, scene.layout.num_columns);
  Vector2d r = Vector2d::Zero();
  double cost = 0;
  for (int column = 0; column < scene.layout.num_columns; ++column) {
    const twin::SeededFrame seeded =
        twin::SeedFrame(scene.body, scene.layout, scene.state, scene.betas, scene.log_focal, column);
    const auto mass = seeded.body.Vertices(scene.vertices);
    const auto feet = seeded.body.Vertices({term.vertices[0], term.vertices[1]});
    twin::Vector3<Jet> d = term.offset_m.cast<Jet>();
    for (size_t i = 0; i < mass.size(); ++i) d += mass[i] * Jet(scene.weights[i]);
    d -= feet[0] * Jet(term.share) + feet[1] * Jet(1 - term.share);
    Vector2d value, slope;
    for (int c = 0; c < 2; ++c) {
      Jet along(0);
      for (int k = 0; k < 3; ++k) along += d[k] * Jet(term.horizontal(c, k) / term.sigma_m);
      value[c] = along.a;
      slope[c] = along.v[0];
    }
    const RobustValue robust = GemanMcClure(value.squaredNorm(), kBalanceKernel);
    cost = 0.5 * term.weight * robust.rho;
    const double scale = std::sqrt(term.weight * robust.weight);
    r = scale * value;
    J.col(column) = scale * slope;
  }
  ASSERT_GT(cost, 0);
  ExpectMatchesTwin(Evaluate(scene), cost, J, r);
}

TEST(BalanceTerm, DerivativesMatchTheTwinInEveryCamera) {
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (const double sigma_m : {0.1, 1.0}) CheckAgainstTwin(*MakeScene(knowledge, sigma_m, 61));
  }
}

TEST(BalanceTerm, HeldJointsHaveNoColumns) {
  CheckAgainstTwin(*MakeScene(CameraKnowledge::kKnown, 0.5, 62, {0, 1, 4}));
}

/// Moving the whole body changes nothing.
TEST(BalanceTerm, TranslationsCancel) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 0.3, 63);
  const FrameSystem before = Evaluate(*scene);
  EXPECT_LT(before.gradient.segment<3>(scene->layout.translation_column).norm(), 1e-12);
  scene->state.translation += Vector3d(0.3, -0.2, 0.9);
  EXPECT_NEAR(Evaluate(*scene).cost, before.cost, 1e-9);
}

}  // namespace
}  // namespace bodyloom::balance_test
