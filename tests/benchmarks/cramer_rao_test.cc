// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/cramer_rao.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

namespace bodyloom::cramer_rao_test {
namespace {

using Eigen::MatrixXd;

MatrixXd RandomMatrix(int rows, int cols, std::mt19937* rng) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, cols, [&] { return normal(*rng); });
}

/// JᵀJ of random residuals that each see `bandwidth + 1` neighbouring frames of p parameters and the s shared ones.
MatrixXd RandomInformation(int T, int p, int s, int bandwidth, unsigned seed) {
  std::mt19937 rng(seed);
  MatrixXd information = MatrixXd::Zero(T * p + s, T * p + s);
  for (int t = 0; t < T; ++t) {
    for (int k = 0; k <= bandwidth && t + k < T; ++k) {
      const int rows = p + s + 1;
      MatrixXd J = MatrixXd::Zero(rows, T * p + s);
      J.middleCols(t * p, (k + 1) * p) = RandomMatrix(rows, (k + 1) * p, &rng);
      J.rightCols(s) = RandomMatrix(rows, s, &rng);
      information += J.transpose() * J;
    }
  }
  return information;
}

TEST(CramerRaoTest, BlocksEqualTheDenseInverse) {
  int checked = 0;
  for (int bandwidth : {0, 1, 2, 3}) {
    for (int T : {1, 2, 3, 5, 8}) {
      for (int s : {0, 2}) {
        const int p = 3;
        const MatrixXd information = RandomInformation(T, p, s, bandwidth, 10 * T + bandwidth);
        const MatrixXd inverse = information.ldlt().solve(MatrixXd::Identity(T * p + s, T * p + s));
        const ClipInformation blocks = ClipInformationFromSparse(information.sparseView(), T, p);
        EXPECT_EQ(static_cast<int>(blocks.band.size()), 1 + std::min(bandwidth, T - 1));
        const ClipCovariance covariance = MarginalCovariances(blocks);
        ASSERT_TRUE(covariance.is_finite) << covariance.message;
        for (int t = 0; t < T; ++t) {
          MatrixXd expected(p + s, p + s);
          expected << inverse.block(t * p, t * p, p, p), inverse.block(t * p, T * p, p, s),
              inverse.block(T * p, t * p, s, p), inverse.bottomRightCorner(s, s);
          EXPECT_LT((covariance.WithShared(t) - expected).norm(), 1e-9 * expected.norm())
              << "T " << T << " bandwidth " << bandwidth << " frame " << t;
          ++checked;
        }
      }
    }
  }
  EXPECT_EQ(checked, 4 * 2 * 19);
}

TEST(CramerRaoTest, OnlyTheUpperTriangleIsRead) {
  MatrixXd information = RandomInformation(4, 3, 2, 2, 1);
  const ClipCovariance full = MarginalCovariances(ClipInformationFromSparse(information.sparseView(), 4, 3));
  information.triangularView<Eigen::StrictlyLower>().setZero();
  const ClipCovariance upper = MarginalCovariances(ClipInformationFromSparse(information.sparseView(), 4, 3));
  for (int t = 0; t < 4; ++t) EXPECT_EQ(full.WithShared(t), upper.WithShared(t));
}

TEST(CramerRaoTest, SingularInformationIsReported) {
  MatrixXd information = RandomInformation(3, 2, 1, 0, 2);
  information.row(3).setZero();  // second parameter of frame 1
  information.col(3).setZero();
  const ClipCovariance covariance = MarginalCovariances(ClipInformationFromSparse(information.sparseView(), 3, 2));
  EXPECT_FALSE(covariance.is_finite);
  EXPECT_NE(covariance.message.find("frames 1..1"), std::string::npos) << covariance.message;

  information = RandomInformation(3, 2, 1, 0, 2);
  information.row(6).setZero();
  information.col(6).setZero();
  EXPECT_FALSE(MarginalCovariances(ClipInformationFromSparse(information.sparseView(), 3, 2)).is_finite);
}

TEST(CramerRaoTest, TwoParametersSeenOnlyTogetherAreSingularWhateverTheRounding) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 rng(seed);
    MatrixXd J = RandomMatrix(9, 3, &rng);
    J.col(2) = J.col(0) / 3 - J.col(1) / 7;
    const MatrixXd information = J.transpose() * J;
    EXPECT_FALSE(MarginalCovariances(ClipInformationFromSparse(information.sparseView(), 1, 3)).is_finite) << seed;
  }
}

TEST(CramerRaoTest, ExpectedNormInClosedForm) {
  const double isotropic = 3 * std::sqrt(std::numbers::pi / 2), line = 3 * std::sqrt(2 / std::numbers::pi);
  EXPECT_NEAR(ExpectedNorm(9 * Eigen::Matrix2d::Identity()), isotropic, 1e-12);
  Eigen::Matrix2d along;
  along << 4.5, -4.5, -4.5, 4.5;  // variance 9 along the diagonal
  EXPECT_NEAR(ExpectedNorm(along), line, 1e-9);
  EXPECT_EQ(ExpectedNorm(Eigen::Matrix2d::Zero()), 0);
}

TEST(CramerRaoTest, ExpectedNormAgainstSampling) {
  Eigen::Matrix2d covariance;
  covariance << 5, 1.5, 1.5, 1;
  const Eigen::Matrix2d L = covariance.llt().matrixL();
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  double sum = 0;
  constexpr int kSamples = 400000;
  for (int i = 0; i < kSamples; ++i) sum += (L * Eigen::Vector2d{normal(rng), normal(rng)}).norm();
  EXPECT_NEAR(ExpectedNorm(covariance), sum / kSamples, 5e-3 * sum / kSamples);
}

// A linear problem reaches its bound: the errors of least squares, sampled, are the expected ones.
TEST(CramerRaoTest, LeastSquaresOfALinearProblemReachesTheBound) {
  std::mt19937 rng(4);
  const int T = 3, p = 2, s = 1, rows = 30;
  MatrixXd J = MatrixXd::Zero(T * rows, T * p + s);
  for (int t = 0; t < T; ++t) {
    J.block(t * rows, t * p, rows, p) = RandomMatrix(rows, p, &rng);
    J.block(t * rows, T * p, rows, s) = RandomMatrix(rows, s, &rng);
  }
  const MatrixXd information = J.transpose() * J;
  const ClipCovariance covariance = MarginalCovariances(ClipInformationFromSparse(information.sparseView(), T, p));
  ASSERT_TRUE(covariance.is_finite);
  const int vertices = 4;
  std::vector<MatrixXd> pixel_jacobians;
  ProjectionBoundAccumulator accumulator;
  for (int t = 0; t < T; ++t) {
    pixel_jacobians.push_back(RandomMatrix(2 * vertices, p + s, &rng));
    accumulator.Add(pixel_jacobians[t], covariance.WithShared(t));
  }
  const Eigen::LLT<MatrixXd> solver(information);
  double sum = 0, squares = 0;
  constexpr int kTrials = 20000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::VectorXd error = solver.solve(J.transpose() * RandomMatrix(T * rows, 1, &rng));
    for (int t = 0; t < T; ++t) {
      const Eigen::VectorXd pixels =
          pixel_jacobians[t].leftCols(p) * error.segment(t * p, p) + pixel_jacobians[t].rightCols(s) * error.tail(s);
      for (int v = 0; v < vertices; ++v) {
        sum += pixels.segment<2>(2 * v).norm();
        squares += pixels.segment<2>(2 * v).squaredNorm();
      }
    }
  }
  const double count = double{kTrials} * T * vertices;
  const ProjectionBound bound = accumulator.Result();
  EXPECT_EQ(bound.num_vertices, T * vertices);
  EXPECT_NEAR(bound.mean_px, sum / count, 0.01 * bound.mean_px);
  EXPECT_NEAR(bound.rms_px, std::sqrt(squares / count), 0.01 * bound.rms_px);
  EXPECT_NEAR(accumulator.Result(0.5).mean_px, 0.5 * bound.mean_px, 1e-12);
}

TEST(CramerRaoTest, BrokenContractsThrow) {
  EXPECT_THROW(ClipInformationFromSparse(Eigen::SparseMatrix<double>(5, 5), 3, 2), std::invalid_argument);
  EXPECT_THROW(MarginalCovariances({}), std::invalid_argument);
  ClipInformation information;
  information.band = {{MatrixXd::Identity(2, 2), MatrixXd::Identity(3, 3)}};
  EXPECT_THROW(MarginalCovariances(information), std::invalid_argument);
  ProjectionBoundAccumulator accumulator;
  EXPECT_THROW(accumulator.Add(MatrixXd::Zero(4, 3), MatrixXd::Zero(2, 2)), std::invalid_argument);
  EXPECT_EQ(accumulator.Result().mean_px, 0);
}

}  // namespace
}  // namespace bodyloom::cramer_rao_test
