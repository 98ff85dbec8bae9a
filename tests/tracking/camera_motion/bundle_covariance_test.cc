// SPDX-License-Identifier: Apache-2.0
// A slope that P points share, each with a height of its own: y_pt = s a_t + h_p + error, with a of zero mean. Its
// least squares are ŝ = Σ a_t y_pt / (P Σ a_t²), ĥ_p the mean of y_p, and the variance of ŝ is aᵀ Σ a / (P (aᵀa)²)
// with Σ the covariance of a point's errors.
#include "tracking/camera_motion/bundle_covariance.h"

#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/sphere_manifold.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace bodyloom::bundle_covariance_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPoints = 80, kFrames = 30, kSpan = 10;

class SlopeCost : public ceres::SizedCostFunction<1, 1, 3> {
 public:
  SlopeCost(double a, double y) : a_(a), y_(y) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = a_ * parameters[0][0] + parameters[1][0] - y_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) jacobians[0][0] = a_;
    if (jacobians[1] != nullptr) jacobians[1][0] = 1, jacobians[1][1] = jacobians[1][2] = 0;
    return true;
  }

 private:
  double a_, y_;
};

double Along(int t) { return (t - 0.5 * (kFrames - 1)) / kFrames; }

enum class Errors { kIndependent, kLasting, kOfSpans, kOfTracks };
constexpr double kKept = 0.9;  ///< of a lasting error, from frame to frame

/// Σ of the header, of variance 1 each.
MatrixXd CovarianceOf(Errors errors) {
  MatrixXd covariance(kFrames, kFrames);
  for (int i = 0; i < kFrames; ++i) {
    for (int j = 0; j < kFrames; ++j) {
      const bool same_span = i / kSpan == j / kSpan;
      covariance(i, j) = errors == Errors::kIndependent ? (i == j ? 1 : 0)
                         : errors == Errors::kLasting   ? std::pow(kKept, std::abs(i - j))
                         : errors == Errors::kOfSpans   ? 0.5 * ((i == j ? 1 : 0) + (same_span ? 1 : 0))
                                                        : 0.5 * ((i == j ? 1 : 0) + 1);
    }
  }
  return covariance;
}

struct Solved {
  double error = 0, variance = 0;  ///< the latter as stated
};

Solved SolveSlope(const MatrixXd& root, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ceres::Problem problem;
  double slope = 0, squares = 0;
  std::vector<Eigen::Vector3d> heights(kPoints, Eigen::Vector3d::Zero());
  BundleBlocks blocks{{&slope}, {}};
  for (Eigen::Vector3d& height : heights) {
    VectorXd fresh(kFrames);
    for (double& value : fresh) value = normal(random);
    const VectorXd errors = root * fresh;
    blocks.points.push_back(height.data());
    for (int t = 0; t < kFrames; ++t) {
      problem.AddResidualBlock(new SlopeCost(Along(t), errors[t]), nullptr, &slope, height.data());
      slope += Along(t) * errors[t];
      squares += Along(t) * Along(t);
    }
    height.x() = errors.mean();
  }
  slope /= squares;
  const std::vector<MatrixXd> covariances = BundleCovariances(&problem, blocks, 1);
  EXPECT_EQ(covariances.size(), 1);
  return {slope, covariances.empty() ? 0 : covariances[0](0, 0)};
}

TEST(BundleCovariance, IsTheScatterWhetherErrorsLastOrNot) {
  VectorXd a(kFrames);
  for (int t = 0; t < kFrames; ++t) a[t] = Along(t);
  const double independent = 1 / (kPoints * a.squaredNorm());
  for (const Errors errors : {Errors::kIndependent, Errors::kLasting, Errors::kOfSpans, Errors::kOfTracks}) {
    const MatrixXd covariance = CovarianceOf(errors), root = covariance.llt().matrixL();
    const double expected = a.dot(covariance * a) / (kPoints * std::pow(a.squaredNorm(), 2));
    constexpr int kSeeds = 200;
    double scatter = 0, stated = 0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const Solved solved = SolveSlope(root, seed);
      scatter += solved.error * solved.error / kSeeds;
      stated += solved.variance / kSeeds;
    }
    EXPECT_NEAR(std::sqrt(stated / expected), 1, 0.03) << int(errors);
    EXPECT_NEAR(std::sqrt(stated / scatter), 1, 0.15) << int(errors);
    if (errors == Errors::kIndependent) {
      EXPECT_NEAR(expected / independent, 1, 1e-12);
    }
    if (errors == Errors::kLasting) {
      EXPECT_GT(expected / independent, 4);
    }
    // An error of a whole track is one of its height.
    if (errors == Errors::kOfTracks) {
      EXPECT_NEAR(expected / independent, 0.5, 1e-12);
    }
  }
}

/// Three numbers on a sphere, measured with variance 1 by a prior: nothing is known along the radius.
class PlaceCost : public ceres::SizedCostFunction<3, 3> {
 public:
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    for (int i = 0; i < 3; ++i) residuals[i] = parameters[0][i];
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(jacobians[0]).setIdentity();
    }
    return true;
  }
};

TEST(BundleCovariance, OfABlockOnASphereIsAcrossItsRadius) {
  for (const double radius : {0.05, 1.0, 7.0}) {
    Eigen::Vector3d place = radius * Eigen::Vector3d(1, 2, 2) / 3;
    ceres::Problem problem;
    problem.AddResidualBlock(new PlaceCost, nullptr, place.data());
    problem.SetManifold(place.data(), new ceres::SphereManifold<3>);
    const std::vector<MatrixXd> covariances = BundleCovariances(&problem, {{place.data()}, {}}, 1);
    ASSERT_EQ(covariances.size(), 1);
    const Eigen::Vector3d out = place.normalized();
    EXPECT_TRUE(covariances[0].isApprox(Eigen::Matrix3d::Identity() - out * out.transpose(), 1e-5)) << covariances[0];
  }
}

}  // namespace
}  // namespace bodyloom::bundle_covariance_test
