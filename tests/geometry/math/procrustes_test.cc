// SPDX-License-Identifier: Apache-2.0
#include "geometry/math/procrustes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/math/rotation.h"

namespace bodyloom::procrustes_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance = 1e-12;

MatrixX3d RandomPoints(int n, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  MatrixX3d points(n, 3);
  for (int i = 0; i < n; ++i) points.row(i) << normal(rng), normal(rng), 0.5 + normal(rng);
  return points;
}

SimilarityTransform SomeTransform() {
  return {1.7, RotationFromAxisAngle({0.4, -2.1, 0.9}), Eigen::Vector3d(3, -2, 5)};
}

double Cost(const SimilarityTransform& transform, const MatrixX3d& source, const MatrixX3d& target,
            const Eigen::VectorXd& weights) {
  return (transform.Apply(source) - target).rowwise().squaredNorm().dot(weights);
}

TEST(ProcrustesTest, RecoversAKnownSimilarity) {
  const MatrixX3d source = RandomPoints(17, 1);
  const SimilarityTransform truth = SomeTransform();
  const AlignmentResult result = AlignPoints(source, truth.Apply(source));
  EXPECT_EQ(result.status, AlignmentStatus::kUnique);
  EXPECT_EQ(result.num_points, 17);
  EXPECT_NEAR(result.target_from_source.scale, 1.7, kTolerance);
  EXPECT_LT((result.target_from_source.rotation - truth.rotation).norm(), kTolerance);
  EXPECT_LT((result.target_from_source.translation - truth.translation).norm(), 1e-11);
}

TEST(ProcrustesTest, RigidKeepsTheScale) {
  const MatrixX3d source = RandomPoints(9, 2);
  const SimilarityTransform truth = SomeTransform();
  const AlignmentResult result = AlignPoints(source, truth.Apply(source), {.estimate_scale = false});
  EXPECT_EQ(result.target_from_source.scale, 1);
  EXPECT_LT((result.target_from_source.rotation - truth.rotation).norm(), kTolerance);
}

// Umeyama's own example (PAMI 1991, section IV), a mirrored triangle with R = [0.832 0.555; −0.555 0.832], lifted from
// the plane into space: two copies far apart, because a half turn out of the plane would mirror a single one exactly.
TEST(ProcrustesTest, UmeyamaTriangleOfThePaper) {
  MatrixX3d source(6, 3), target(6, 3);
  const double z = 100;
  source << 0, 0, z, 1, 0, z, 0, 2, z, 0, 0, -z, 1, 0, -z, 0, 2, -z;
  target << 0, 0, z, -1, 0, z, 0, 2, z, 0, 0, -z, -1, 0, -z, 0, 2, -z;
  const AlignmentResult result = AlignPoints(source, target, {.estimate_scale = false});
  EXPECT_NEAR(result.target_from_source.rotation(0, 0), 3 / std::sqrt(13.0), 1e-12);
  EXPECT_NEAR(result.target_from_source.rotation(0, 1), 2 / std::sqrt(13.0), 1e-12);
  EXPECT_NEAR(result.target_from_source.rotation.determinant(), 1, kTolerance);
}

TEST(ProcrustesTest, MirrorImageGivesARotationAndTheBestOne) {
  const MatrixX3d source = RandomPoints(20, 3);
  MatrixX3d target = source;
  target.col(0) *= -1;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(20);
  const AlignmentResult result = AlignPoints(source, target);
  EXPECT_NEAR(result.target_from_source.rotation.determinant(), 1, kTolerance);
  const double best = Cost(result.target_from_source, source, target, ones);
  EXPECT_GT(best, 0.1);
  std::mt19937 rng(4);
  std::normal_distribution<double> normal(0, 0.05);
  for (int trial = 0; trial < 200; ++trial) {
    SimilarityTransform other = result.target_from_source;
    other.rotation *= RotationFromAxisAngle({normal(rng), normal(rng), normal(rng)});
    other.scale += normal(rng);
    other.translation += Eigen::Vector3d{normal(rng), normal(rng), normal(rng)};
    EXPECT_GE(Cost(other, source, target, ones), best);
  }
}

TEST(ProcrustesTest, WeightsAreThoseOfTheCost) {
  const MatrixX3d source = RandomPoints(12, 5);
  const MatrixX3d target = SomeTransform().Apply(source) + 0.3 * RandomPoints(12, 6);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(12);
  for (int i = 0; i < 12; ++i) weights[i] = 1 + i;
  // A weight of k is the same as k copies.
  MatrixX3d source_copies(0, 3), target_copies(0, 3);
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k <= i; ++k) {
      source_copies.conservativeResize(source_copies.rows() + 1, 3);
      target_copies.conservativeResize(target_copies.rows() + 1, 3);
      source_copies.bottomRows(1) = source.row(i);
      target_copies.bottomRows(1) = target.row(i);
    }
  }
  const SimilarityTransform a = AlignPoints(source, target, {}, weights).target_from_source;
  const SimilarityTransform b = AlignPoints(source_copies, target_copies).target_from_source;
  EXPECT_LT((a.rotation - b.rotation).norm(), kTolerance);
  EXPECT_NEAR(a.scale, b.scale, kTolerance);
  const SimilarityTransform plain = AlignPoints(source, target).target_from_source;
  EXPECT_GT((a.rotation - plain.rotation).norm(), 1e-4);
}

TEST(ProcrustesTest, NonFinitePairsAreLeftOut) {
  MatrixX3d source = RandomPoints(8, 7);
  MatrixX3d target = SomeTransform().Apply(source);
  source(2, 1) = kNaN;
  target(5, 0) = std::numeric_limits<double>::infinity();
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(8);
  weights[6] = kNaN;
  weights[7] = 0;
  const AlignmentResult result = AlignPoints(source, target, {}, weights);
  EXPECT_EQ(result.num_points, 4);
  EXPECT_LT((result.target_from_source.rotation - SomeTransform().rotation).norm(), kTolerance);
}

TEST(ProcrustesTest, CollinearPointsKeepTheIdentityRotation) {
  MatrixX3d source(5, 3), target(5, 3);
  for (int i = 0; i < 5; ++i) {
    source.row(i) << 0.1 * i, 0.2 * i, 0.3;
    target.row(i) << 1 - 0.2 * i, 2, 3 - 0.4 * i;  // twice the length
  }
  const AlignmentResult result = AlignPoints(source, target);
  EXPECT_EQ(result.status, AlignmentStatus::kAmbiguous);
  EXPECT_EQ(result.target_from_source.rotation, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(result.target_from_source.scale, 2, kTolerance);
  EXPECT_LT((result.target_from_source.Apply(source).colwise().mean() - target.colwise().mean()).norm(), kTolerance);
}

TEST(ProcrustesTest, CoincidingPointsOnePointAndNone) {
  MatrixX3d same(6, 3);
  same.rowwise() = Eigen::RowVector3d(0.1, 2.2, 3.3);  // sums that round: the mean is not exactly the point
  AlignmentResult result = AlignPoints(same, RandomPoints(6, 8));
  EXPECT_EQ(result.status, AlignmentStatus::kAmbiguous);
  EXPECT_EQ(result.target_from_source.scale, 1);
  EXPECT_EQ(result.target_from_source.rotation, Eigen::Matrix3d::Identity());

  result = AlignPoints(same.topRows(1), RandomPoints(1, 9));
  EXPECT_EQ(result.status, AlignmentStatus::kAmbiguous);
  EXPECT_EQ(result.num_points, 1);

  result = AlignPoints(MatrixX3d(0, 3), MatrixX3d(0, 3));
  EXPECT_EQ(result.status, AlignmentStatus::kNoPoints);
  result = AlignPoints(MatrixX3d::Constant(3, 3, kNaN), RandomPoints(3, 10));
  EXPECT_EQ(result.status, AlignmentStatus::kNoPoints);
  EXPECT_EQ(result.target_from_source.scale, 1);
}

TEST(ProcrustesTest, PlanarPointsAreNotDegenerate) {
  MatrixX3d source = RandomPoints(10, 11);
  source.col(2).setConstant(4);
  const SimilarityTransform truth = SomeTransform();
  const AlignmentResult result = AlignPoints(source, truth.Apply(source));
  EXPECT_EQ(result.status, AlignmentStatus::kUnique);
  EXPECT_LT((result.target_from_source.rotation - truth.rotation).norm(), 1e-11);
}

TEST(ProcrustesTest, BrokenContractsThrow) {
  EXPECT_THROW(AlignPoints(RandomPoints(3, 1), RandomPoints(4, 1)), std::invalid_argument);
  EXPECT_THROW(AlignPoints(RandomPoints(3, 1), RandomPoints(3, 2), {}, Eigen::VectorXd::Ones(2)),
               std::invalid_argument);
  EXPECT_THROW(AlignPoints(RandomPoints(3, 1), RandomPoints(3, 2), {}, Eigen::Vector3d(1, -1, 1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::procrustes_test
