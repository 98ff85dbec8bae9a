// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/sigma_reliability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "geometry/scene/observations.h"

namespace bodyloom::sigma_reliability_test {
namespace {

std::vector<JudgedSigma> Drawn(int count, double stated_over_true) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<JudgedSigma> pairs;
  for (int i = 0; i < count; ++i) {
    const double sigma = std::exp(0.5 * normal(random) - 3);
    const Eigen::Vector3d error = sigma * Eigen::Vector3d::NullaryExpr([&]() { return normal(random); });
    pairs.push_back({error.norm(), stated_over_true * sigma});
  }
  return pairs;
}

// P(chi_3 <= x) = erf(x/sqrt 2) - sqrt(2/pi) x exp(-x^2/2).
double ChiWithin(double x) { return std::erf(x / std::sqrt(2)) - std::sqrt(2 / M_PI) * x * std::exp(-x * x / 2); }

TEST(SigmaReliability, TrueSigmasHaveTheSharesOfAChiDistribution) {
  for (const double factor : {1.0, 0.5}) {
    const SigmaReliability of = JudgeSigmas(Drawn(100000, factor));
    for (int i = 1; i <= 3; ++i) EXPECT_NEAR(of.within_percent[i - 1], 100 * ChiWithin(i * factor), 0.6) << i;
  }
  // The spread of log sigma, 0.5, against that of log chi_3 (variance psi'(3/2)/4).
  const double noise = (M_PI * M_PI / 2 - 4) / 4;
  EXPECT_NEAR(JudgeSigmas(Drawn(100000, 1)).log_correlation, std::sqrt(0.25 / (0.25 + noise)), 0.01);
}

TEST(SigmaReliability, TheSurestAreThoseOfTheLeastSigma) {
  std::vector<JudgedSigma> pairs;
  for (int i = 20; i >= 1; --i) pairs.push_back({i * 0.01, i * 0.1});
  const SigmaReliability of = JudgeSigmas(pairs);
  EXPECT_NEAR(of.mean_m, 0.105, 1e-12);
  EXPECT_NEAR(of.surest_90_m, 0.095, 1e-12);
  EXPECT_NEAR(of.surest_75_m, 0.08, 1e-12);
  EXPECT_NEAR(of.log_correlation, 1, 1e-12);
  EXPECT_EQ(of.within_percent, (std::array<double, 3>{100, 100, 100}));
}

TEST(SigmaReliability, WhatIsNotKnownIsLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<JudgedSigma> pairs = {{nan, 1}, {1, nan}, {1, 0}, {1, 2}, {3, 1.9}};
  EXPECT_EQ(JudgeSigmas(pairs).count, 2);
  EXPECT_EQ(JudgeSigmas(pairs).within_percent[0], 50);
  EXPECT_EQ(JudgeSigmas({}).count, 0);
  EXPECT_TRUE(std::isnan(JudgeSigmas({}).mean_m));
  Evaluation result;
  AddSigmaReliability({}, &result);
  EXPECT_TRUE(result.values.empty());
}

TEST(SigmaReliability, ALandmarkHasTheSigmaOfItsJointInTheFrameThatIsScored) {
  Track track;
  track.joint_sigma.resize(2, 24);
  for (int j = 0; j < 24; ++j) track.joint_sigma.col(j) << 100 + j, 200 + j;
  std::vector<MatrixX3d> found(1, MatrixX3d::Zero(17, 3)), truth = found;
  truth[0].col(1).setLinSpaced(0, 16);
  const std::vector<JudgedSigma> pairs = JudgedLandmarks(track, {1}, found, truth);
  ASSERT_EQ(pairs.size(), 12U);
  const int joints[] = {16, 17, 18, 19, 20, 21, 1, 2, 4, 5, 7, 8};  // SMPL's shoulders … ankles
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(pairs[i].error_m, 5 + i);
    EXPECT_EQ(pairs[i].sigma_m, 200 + joints[i]) << CocoNames()[5 + i];
  }
}

TEST(SigmaReliability, JointsAreComparedAboutTheHips) {
  Track track;
  track.joint_sigma.setConstant(1, 24, 0.5);
  std::vector<MatrixX3d> truth(1, BuiltinBody().joint_template()), found = truth;
  found[0].rowwise() += Eigen::RowVector3d(0.3, -0.2, 4);
  found[0](20, 2) += 0.25;
  const std::vector<JudgedSigma> pairs = JudgedJoints(track, {0}, BuiltinBody(), found, truth);
  ASSERT_EQ(pairs.size(), 23U);
  for (int j = 1; j < 24; ++j) EXPECT_NEAR(pairs[j - 1].error_m, j == 20 ? 0.25 : 0, 1e-12) << j;
}

}  // namespace
}  // namespace bodyloom::sigma_reliability_test
