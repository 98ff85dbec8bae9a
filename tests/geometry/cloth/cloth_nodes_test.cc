// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_nodes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"

namespace bodyloom::cloth_nodes_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

LooseGarment Skirt() {
  LooseGarmentOptions options;
  options.waist_y_m = 0.09, options.length_m = 0.55, options.fullness = 0.5;
  const BodyModel& body = ToyBody();
  return CutLooseGarment(body.data().v_template, body.data().faces, 0.3, options);
}

/// Position of a point of the sewn garment's space, moved with its nearest nodes.
Vector3d Carried(const ClothNodes& nodes, const MovedNodes& moved, const Vector3d& point) {
  const NearestNodes near = nodes.Near(point);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < NearestNodes::kCount; ++i) {
    const int k = near.node[i];
    sum += near.weight[i] *
           (moved.rotations[k] * (point - nodes.places().row(k).transpose()) + moved.places.row(k).transpose());
  }
  return sum;
}

TEST(ClothNodes, AreVerticesApartThatLeaveNoneFar) {
  const LooseGarment skirt = Skirt();
  for (const double spacing : {0.05, 0.12}) {
    const ClothNodes nodes(skirt, spacing);
    for (int a = 0; a < nodes.size(); ++a) {
      EXPECT_TRUE(std::any_of(skirt.sewn.begin(), skirt.sewn.end(),
                              [&](const Vector3d& v) { return v == nodes.places().row(a).transpose(); }));
      for (int b = 0; b < a; ++b) EXPECT_GE((nodes.places().row(a) - nodes.places().row(b)).norm(), spacing);
    }
    for (const Vector3d& v : skirt.sewn) {
      EXPECT_LT((nodes.places().rowwise() - v.transpose()).rowwise().norm().minCoeff(), spacing);
    }
  }
}

TEST(ClothNodes, CarryRigidMotionsExactly) {
  const LooseGarment skirt = Skirt();
  const ClothNodes nodes(skirt, 0.06);
  const Matrix3d R = RotationFromAxisAngle({0.7, -1.9, 0.4});
  const Vector3d t(0.3, -1, 2);
  std::vector<Vector3d> cloth;
  for (const Vector3d& v : skirt.sewn) cloth.push_back(R * v + t);
  const MovedNodes moved = nodes.Move(cloth);
  for (const Matrix3d& rotation : moved.rotations) EXPECT_LT((rotation - R).norm(), 1e-9);
  for (const Vector3d& off : {Vector3d(0, 0, 0), Vector3d(0.02, 0.1, -0.03)}) {
    const Vector3d point = skirt.sewn[skirt.sewn.size() / 2] + off;
    EXPECT_LT((Carried(nodes, moved, point) - (R * point + t)).norm(), 1e-9);
  }
}

/// The cone bent smoothly: what is carried is off by what a fold of this size is on the way from node to node.
TEST(ClothNodes, FollowFoldsThatAreWiderThanTheyAreApart) {
  const LooseGarment skirt = Skirt();
  const auto bent = [](const Vector3d& v) {
    return Vector3d(v.x() + 0.1 * std::sin(5 * v.y()), v.y(), v.z() + 0.05 * std::sin(6 * v.x()));
  };
  std::vector<Vector3d> cloth;
  for (const Vector3d& v : skirt.sewn) cloth.push_back(bent(v));
  double last = 1;
  for (const double spacing : {0.12, 0.06, 0.03}) {
    const ClothNodes nodes(skirt, spacing);
    const MovedNodes moved = nodes.Move(cloth);
    double worst = 0;
    for (size_t v = 0; v < cloth.size(); ++v) {
      worst = std::max(worst, (Carried(nodes, moved, skirt.sewn[v]) - cloth[v]).norm());
    }
    EXPECT_LT(worst, 0.7 * last) << spacing;
    last = worst;
  }
  EXPECT_LT(last, 0.006);
}

TEST(ClothNodes, WeightsFallWithDistance) {
  const LooseGarment skirt = Skirt();
  const ClothNodes nodes(skirt, 0.06);
  const NearestNodes near = nodes.Near(nodes.places().row(17).transpose());
  EXPECT_EQ(near.node[0], 17);
  EXPECT_NEAR(std::accumulate(near.weight.begin(), near.weight.end(), 0.0), 1, 1e-12);
  EXPECT_TRUE(std::is_sorted(near.weight.rbegin(), near.weight.rend()));
  const double d2 = (nodes.places().row(near.node[1]) - nodes.places().row(17)).squaredNorm();
  EXPECT_NEAR(near.weight[1] / near.weight[0], std::exp(-d2 / (2 * 0.036 * 0.036)), 1e-12);
  // Far away the nearest still count.
  const NearestNodes far = nodes.Near({100, 0, 0});
  EXPECT_NEAR(std::accumulate(far.weight.begin(), far.weight.end(), 0.0), 1, 1e-12);
}

TEST(ClothNodes, StayFiniteWhereClothHasCollapsed) {
  const LooseGarment skirt = Skirt();
  const ClothNodes nodes(skirt, 0.06);
  std::vector<Vector3d> line, point(skirt.sewn.size(), Vector3d(1, 2, 3));
  for (const Vector3d& v : skirt.sewn) line.emplace_back(v.x(), 0, 0);
  for (const auto& cloth : {line, point}) {
    const MovedNodes moved = nodes.Move(cloth);
    for (const Matrix3d& rotation : moved.rotations) {
      EXPECT_LT((rotation * rotation.transpose() - Matrix3d::Identity()).norm(), 1e-9);
      EXPECT_NEAR(rotation.determinant(), 1, 1e-9);
    }
  }
}

TEST(ClothNodes, RefuseWhatTheyCannotBeOn) {
  const LooseGarment skirt = Skirt();
  EXPECT_THROW(ClothNodes(LooseGarment{}, 0.05), std::invalid_argument);
  EXPECT_THROW(ClothNodes(skirt, 0), std::invalid_argument);
  EXPECT_THROW(ClothNodes(skirt, std::nan("")), std::invalid_argument);
  EXPECT_THROW(ClothNodes(skirt, 0.05).Move(std::vector<Vector3d>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::cloth_nodes_test
