// SPDX-License-Identifier: Apache-2.0
// Heights above the ground in the frame cost against automatic differentiation of their formula.
#include "tracking/terms/surface_contact/surface_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/problem/robust.h"

namespace bodyloom::surface_contact_test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using twin::Jet;

/// A random pose with a ground at the median height of a few vertices; every other one touches it.
std::unique_ptr<FrameScene> MakeScene(CameraKnowledge knowledge, uint64_t seed, std::vector<int> active = {}) {
  auto scene = std::make_unique<FrameScene>();
  std::mt19937_64 random(seed);
  if (active.empty()) active = AllJoints(scene->body);
  PlaceCamera(knowledge, MakePinhole(1280, 720, 1000), 1100, active, &random, scene.get());
  PoseAtRandom(knowledge, 0.5, &random, scene.get());
  auto& term = scene->data.Get<SurfaceContactTerm>();
  term.up = Vector3d(0.1, -0.9, -0.2).normalized();
  term.weight = 0.7;
  term.sigma_m = 0.3;
  const int V = scene->body.num_vertices();
  Kinematics kinematics;
  kinematics.Set(scene->body, scene->betas, scene->state.rotations, Vector3d::Zero(), false);
  PointEvaluator::VertexCache cache;
  cache.NewFrame(kinematics);
  std::vector<double> heights;
  for (int k = 0; k < 9; ++k) {
    const int v = k * (V - 1) / 8;
    term.contacts.push_back({v, k % 2 == 0, 0.002 * k});
    heights.push_back(
        term.up.dot(PointEvaluator::VertexPosition(kinematics, v, &cache) + scene->layout.BodyPlace(scene->state)));
    if (k % 4 != 0) continue;
    term.contacts.back().held_m = PointEvaluator::VertexPosition(kinematics, v, &cache) +
                                  scene->layout.BodyPlace(scene->state) + Vector3d(0.02, 0.01 * k, -0.05);
  }
  std::sort(heights.begin(), heights.end());
  term.level_m = heights[4];
  return scene;
}

void CheckAgainstTwin(const FrameScene& scene) {
  const auto& term = scene.data.Get<SurfaceContactTerm>();
  Eigen::Index count = 0;
  for (const auto& contact : term.contacts) count += contact.held_m ? 3 : 1;
  const Vector3d across[2] = {term.up.unitOrthogonal(), term.up.cross(term.up.unitOrthogonal())};
  MatrixXd J = MatrixXd::Zero(count, scene.layout.num_columns);
  VectorXd r = VectorXd::Zero(count);
  double cost = 0;
  int below = 0;
  for (int column = 0; column < scene.layout.num_columns; ++column) {
    const twin::SeededFrame seeded =
        twin::SeedFrame(scene.body, scene.layout, scene.state, scene.betas, scene.log_focal, column);
    cost = 0;
    below = 0;
    Eigen::Index row = 0;
    for (const auto& contact : term.contacts) {
      twin::Vector3<Jet> x = seeded.body.Vertices({contact.vertex})[0];
      if (scene.layout.knowledge == CameraKnowledge::kWeak) {
        twin::Vector3<Jet> t;
        for (int c = 0; c < 3; ++c) {
          t[c] = Jet(scene.state.translation[c]);
          if (column == scene.layout.translation_column + c) t[c].v[0] = 1;
        }
        x += twin::Vector3<Jet>(t[1], t[2], Jet(scene.layout.camera.fx) / exp(t[0]));
      }
      if (contact.held_m) {
        const twin::Vector3<Jet> off = x - contact.held_m->cast<Jet>();
        Jet both[2];
        for (int a = 0; a < 2; ++a) both[a] = across[a].cast<Jet>().dot(off) / Jet(term.hold_sigma_m);
        const RobustValue robust = GemanMcClure(both[0].a * both[0].a + both[1].a * both[1].a, kHoldKernel);
        cost += 0.5 * kHoldWeight * term.weight * robust.rho;
        for (const Jet& one : both) {
          const double scale = std::sqrt(kHoldWeight * term.weight * robust.weight);
          r[row] = scale * one.a;
          J(row++, column) = scale * one.v[0];
        }
      }
      const twin::Vector3<Jet> up = term.up.cast<Jet>();
      Jet height = (up.dot(x) - Jet(term.level_m + contact.rest_m)) / Jet(term.sigma_m);
      const Eigen::Index k = row++;
      if (!contact.touches && height.a >= 0) continue;
      below += contact.touches ? 0 : 1;
      const RobustValue robust = GemanMcClure(height.a * height.a, kSurfaceContactKernel);
      cost += 0.5 * term.weight * robust.rho;
      const double scale = std::sqrt(term.weight * robust.weight);
      r[k] = scale * height.a;
      J(k, column) = scale * height.v[0];
    }
  }
  ASSERT_GT(below, 0);
  ExpectMatchesTwin(Evaluate(scene), cost, J, r);
}

TEST(SurfaceContact, DerivativesMatchTheTwinInEveryCamera) {
  for (const CameraKnowledge knowledge :
       {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    CheckAgainstTwin(*MakeScene(knowledge, 51));
  }
}

TEST(SurfaceContact, HeldJointsHaveNoColumns) { CheckAgainstTwin(*MakeScene(CameraKnowledge::kKnown, 52, {0, 1, 4})); }

TEST(SurfaceContact, AboveTheGroundOnlyTouchingPointsCost) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 53);
  auto& term = scene->data.Get<SurfaceContactTerm>();
  term.level_m -= 10;
  for (auto& contact : term.contacts) {
    contact.touches = false;
    contact.held_m.reset();
  }
  EXPECT_EQ(Evaluate(*scene).cost, 0);
  EXPECT_EQ(Evaluate(*scene).gradient.norm(), 0);
  term.contacts[3].touches = true;
  EXPECT_GT(Evaluate(*scene).cost, 1);
}

/// One by one, as Ceres takes them, every point has a row at every state.
TEST(SurfaceContact, RowsDoNotDependOnTheState) {
  auto scene = MakeScene(CameraKnowledge::kKnown, 54);
  FrameEvaluator evaluator;
  FrameRows rows;
  evaluator.EvaluateRows(scene->layout, scene->data, scene->state, *scene, FrameAccumulator::Mode::kRows, &rows);
  EXPECT_EQ(rows.groups.size(), 12U);
  scene->data.Get<SurfaceContactTerm>().level_m -= 10;
  evaluator.EvaluateRows(scene->layout, scene->data, scene->state, *scene, FrameAccumulator::Mode::kRows, &rows);
  EXPECT_EQ(rows.groups.size(), 12U);
}

}  // namespace
}  // namespace bodyloom::surface_contact_test
