// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/global_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/math/rotation.h"

namespace bodyloom::global_errors_test {
namespace {

constexpr int kJoints = 5;

/// A cloud of joints that goes 1 cm to the right in every frame.
std::vector<MatrixX3d> Walk(int T) {
  std::mt19937 rng(2);
  std::normal_distribution<double> normal;
  MatrixX3d shape(kJoints, 3);
  for (Eigen::Index i = 0; i < shape.size(); ++i) shape.data()[i] = 0.3 * normal(rng);
  std::vector<MatrixX3d> frames;
  for (int t = 0; t < T; ++t) {
    MatrixX3d frame = shape.rowwise() + Eigen::RowVector3d(0.01 * t, 0.2 * std::sin(0.1 * t), 0);
    frames.push_back(frame);
  }
  return frames;
}

MatrixX3d Roots(const std::vector<MatrixX3d>& frames) {
  MatrixX3d roots(frames.size(), 3);
  for (size_t t = 0; t < frames.size(); ++t) roots.row(Eigen::Index(t)) = frames[t].row(0);
  return roots;
}

GlobalErrors Measure(const std::vector<MatrixX3d>& a, const std::vector<MatrixX3d>& b) {
  return MeasureGlobalErrors(a, b, Roots(a), Roots(b));
}

TEST(GlobalErrors, SimilaritiesAreForgivenBySizeAndPlaceButNotInThePath) {
  const std::vector<MatrixX3d> truth = Walk(250);
  const Eigen::Matrix3d turn = RotationFromAxisAngle(Eigen::Vector3d(0.3, -1, 0.5));
  std::vector<MatrixX3d> moved, scaled;
  for (const MatrixX3d& frame : truth) {
    moved.emplace_back((frame * turn.transpose()).rowwise() + Eigen::RowVector3d(3, 1, -2));
    scaled.emplace_back(2 * frame);
  }
  const GlobalErrors same = Measure(moved, truth), larger = Measure(scaled, truth);
  for (const double error : {same.w_mpjpe_100_m, same.wa_mpjpe_100_m, same.rte, larger.w_mpjpe_100_m}) {
    EXPECT_NEAR(error, 0, 1e-9);
  }
  EXPECT_GT(larger.rte, 0.02) << "one rigid motion does not change the size";
}

TEST(GlobalErrors, DriftInClosedForm) {
  // In each window of 100 frames the track goes 1 mm a frame too far in depth; it begins right.
  const std::vector<MatrixX3d> truth = Walk(200);
  std::vector<MatrixX3d> drifting = truth;
  for (int t = 0; t < 200; ++t) drifting[size_t(t)].col(2).array() += 0.001 * (t % 100);
  const GlobalErrors errors = Measure(drifting, truth);
  // Fitted on two frames whose errors are 0 and 1 mm, what is left grows to 99 mm: about 49 mm in the mean.
  EXPECT_NEAR(errors.w_mpjpe_100_m, 0.0495, 0.012);
  // Fitted on all, a plane's tilt takes most of a linear drift.
  EXPECT_LT(errors.wa_mpjpe_100_m, 0.6 * errors.w_mpjpe_100_m);
}

TEST(GlobalErrors, PathIsTheMeasureOfTheRoots) {
  // A path of 10 m along x, of which the track goes 9 m: after one rigid motion frame t is 1 cm · (t − 50) off.
  MatrixX3d roots = MatrixX3d::Zero(101, 3), true_roots = roots;
  for (int t = 0; t <= 100; ++t) {
    roots(t, 0) = 0.09 * t;
    true_roots(t, 0) = 0.1 * t;
  }
  const std::vector<MatrixX3d> joints(101, MatrixX3d::Identity(3, 3));
  EXPECT_NEAR(MeasureGlobalErrors(joints, joints, roots, true_roots).rte, 0.01 * 2550 / 101 / 10, 1e-9);
  EXPECT_TRUE(std::isnan(MeasureGlobalErrors(joints, joints, roots, MatrixX3d::Zero(101, 3)).rte)) << "no path";
}

TEST(GlobalErrors, ShortClipsAndWrongSizes) {
  const std::vector<MatrixX3d> truth = Walk(99);
  EXPECT_TRUE(std::isnan(Measure(truth, truth).wa_mpjpe_100_m)) << "no whole window";
  EXPECT_NEAR(Measure(truth, truth).rte, 0, 1e-9);
  EXPECT_THROW(MeasureGlobalErrors(truth, Walk(98), Roots(truth), Roots(truth)), std::invalid_argument);
  std::vector<MatrixX3d> fewer = truth;
  fewer[3] = fewer[3].topRows(2).eval();
  EXPECT_THROW(Measure(fewer, truth), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::global_errors_test
