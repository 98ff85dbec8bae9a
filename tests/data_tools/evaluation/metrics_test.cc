// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/math/rotation.h"

namespace bodyloom::metrics_test {
namespace {

constexpr double kTolerance = 1e-12;

std::vector<MatrixX3d> RandomClip(int frames, int points, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<MatrixX3d> clip(frames, MatrixX3d(points, 3));
  for (MatrixX3d& frame : clip) {
    for (int i = 0; i < points; ++i) frame.row(i) << normal(rng), normal(rng), 3 + normal(rng);
  }
  return clip;
}

std::vector<MatrixX3d> Shifted(std::vector<MatrixX3d> clip, const Eigen::RowVector3d& offset) {
  for (MatrixX3d& frame : clip) frame.rowwise() += offset;
  return clip;
}

std::vector<double> Times(int frames, double fps) {
  std::vector<double> times;
  times.reserve(static_cast<size_t>(frames));
  for (int t = 0; t < frames; ++t) times.push_back(t / fps);
  return times;
}

TEST(MetricsTest, SummarizeCountsWhatItLeavesOut) {
  const ErrorStatistics s = Summarize(std::vector<double>{2, 4, 4, 4, 5, 5, 7, 9, kNotMeasured, INFINITY});
  EXPECT_DOUBLE_EQ(s.mean, 5);
  EXPECT_DOUBLE_EQ(s.std_dev, 2);
  EXPECT_DOUBLE_EQ(s.median, 4.5);
  EXPECT_DOUBLE_EQ(s.max, 9);
  EXPECT_EQ(s.count, 8);
  EXPECT_EQ(s.missing, 2);
  EXPECT_TRUE(std::isnan(Summarize({}).mean));
}

TEST(MetricsTest, NearestFrameWithAResult) {
  EXPECT_EQ(NearestFramesWithResult({false, true, false, false, false, true, false}),
            (std::vector<int>{1, 1, 1, 1, 5, 5, 5}));  // frame 3 is as far from 1 as from 5: the earlier wins
  EXPECT_TRUE(NearestFramesWithResult({false, false}).empty());
  EXPECT_TRUE(NearestFramesWithResult({}).empty());
}

TEST(MetricsTest, KnownOffsetIsThePositionErrorAndVanishesAtTheRoot) {
  const std::vector<MatrixX3d> truth = RandomClip(6, 24, 1);
  const std::vector<MatrixX3d> moved = Shifted(truth, {3, 0, -4});
  const PositionError raw = MeanPositionError(moved, truth);
  EXPECT_NEAR(raw.mean, 5, kTolerance);
  EXPECT_NEAR(raw.frames.p95, 5, kTolerance);
  EXPECT_EQ(raw.count, 6 * 24);
  const std::vector<int> hips = {1, 2};
  const PositionError mpjpe =
      MeanPositionError(RelativeTo(moved, RootPositions(moved, hips)), RelativeTo(truth, RootPositions(truth, hips)));
  EXPECT_NEAR(mpjpe.mean, 0, kTolerance);
}

TEST(MetricsTest, RootChoicesDiffer) {
  std::vector<MatrixX3d> truth = RandomClip(1, 3, 2), moved = truth;
  moved[0].row(0) += Eigen::RowVector3d(0, 0, 0.3);  // the pelvis alone is off
  const auto mpjpe = [&](const std::vector<int>& root) {
    return MeanPositionError(RelativeTo(moved, RootPositions(moved, root)),
                             RelativeTo(truth, RootPositions(truth, root)))
        .mean;
  };
  EXPECT_NEAR(mpjpe({0}), 0.2, kTolerance);     // the two others are off by 0.3
  EXPECT_NEAR(mpjpe({1, 2}), 0.1, kTolerance);  // the pelvis is
}

TEST(MetricsTest, ErrorsByPointAndFrame) {
  std::vector<MatrixX3d> truth(2, MatrixX3d::Zero(2, 3)), estimate = truth;
  estimate[0].row(1) << 0, 0, 1;
  estimate[1].row(1) << 0, 3, 0;
  estimate[1].row(0) << 2, 0, 0;
  const PositionError e = MeanPositionError(estimate, truth);
  EXPECT_DOUBLE_EQ(e.mean, 1.5);
  EXPECT_DOUBLE_EQ(e.per_point[0], 1);
  EXPECT_DOUBLE_EQ(e.per_point[1], 2);
  EXPECT_DOUBLE_EQ(e.frames.mean, 1.5);
  EXPECT_DOUBLE_EQ(e.frames.std_dev, 1);
  EXPECT_EQ(e.of_frame, (std::vector<double>{0.5, 2.5}));
}

TEST(MetricsTest, PercentAboveLeavesOutWhatIsNotKnown) {
  EXPECT_DOUBLE_EQ(PercentAbove(std::vector<double>{0.1, 0.12, kNotMeasured, 0.13, 0.5}, 0.12), 50);
  EXPECT_TRUE(std::isnan(PercentAbove(std::vector<double>{kNotMeasured}, 0.12)));
}

TEST(MetricsTest, ClipScaleUndoesAKnownScale) {
  const std::vector<MatrixX3d> truth = RandomClip(5, 17, 3);
  std::vector<MatrixX3d> small = truth;
  for (MatrixX3d& frame : small) frame *= 0.8;
  EXPECT_NEAR(ClipScale(small, truth), 1.25, kTolerance);
  EXPECT_NEAR(MeanPositionError(small, truth, ClipScale(small, truth)).mean, 0, kTolerance);
  // The least-squares scale of a noisy prediction leaves a residual orthogonal to it.
  std::vector<MatrixX3d> noisy = RandomClip(5, 17, 4);
  const double s = ClipScale(noisy, truth);
  double dot = 0;
  for (int t = 0; t < 5; ++t) dot += (noisy[t].array() * (s * noisy[t] - truth[t]).array()).sum();
  EXPECT_NEAR(dot, 0, 1e-9);
  EXPECT_TRUE(std::isnan(ClipScale(std::vector<MatrixX3d>(2, MatrixX3d::Zero(3, 3)), RandomClip(2, 3, 1))));
}

TEST(MetricsTest, ProcrustesErrorIgnoresASimilarityPerFrame) {
  const std::vector<MatrixX3d> truth = RandomClip(4, 17, 5);
  std::vector<MatrixX3d> moved = truth;
  for (int t = 0; t < 4; ++t) {
    moved[t] = (0.5 + t) * truth[t] * RotationFromAxisAngle({0.1 * t, 1, -t * 0.7}).transpose();
  }
  EXPECT_GT(MeanPositionError(moved, truth).mean, 0.5);
  EXPECT_NEAR(ProcrustesPositionError(moved, truth).mean, 0, 1e-11);
}

// A regular tetrahedron with one corner pulled out along its axis: closed form by symmetry. Corners of a regular
// tetrahedron are a, b, c, d with zero sum; moving d to (1 + ε)d changes to first order the scale, the centre and
// leaves no rotation.
TEST(MetricsTest, ProcrustesErrorOfATetrahedron) {
  MatrixX3d truth(4, 3);
  truth << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  MatrixX3d pulled = truth;
  const double epsilon = 0.4;
  pulled.row(3) *= 1 + epsilon;
  // With means removed, p_i = truth_i − εd/4 (i < 3), p_3 = (1 + 3ε/4) d; ⟨truth_i, d⟩ = −1, |d|² = 3.
  const double dot = 3 * (3 + epsilon / 4) + 3 * (1 + 3 * epsilon / 4);
  const double square = 3 * (3 + epsilon / 2 + 3 * epsilon * epsilon / 16) + 3 * std::pow(1 + 3 * epsilon / 4, 2);
  const double s = dot / square;
  const double corner = std::sqrt(3.0) * std::abs(s * (1 + 3 * epsilon / 4) - 1);
  // s p_i − truth_i = (s − 1) truth_i − s ε/4 d
  const double other =
      std::sqrt((s - 1) * (s - 1) * 3 + (s - 1) * s * epsilon / 2 + s * s * epsilon * epsilon * 3 / 16);
  const PositionError e = ProcrustesPositionError(std::vector<MatrixX3d>{pulled}, std::vector<MatrixX3d>{truth});
  EXPECT_NEAR(e.mean, (3 * other + corner) / 4, kTolerance);
}

TEST(MetricsTest, MissingPointsAreLeftOutAndCounted) {
  const std::vector<MatrixX3d> truth = RandomClip(3, 17, 6);
  std::vector<MatrixX3d> moved = Shifted(truth, {0, 2, 0});
  moved[1].setConstant(kNotMeasured);
  moved[2](4, 0) = kNotMeasured;
  const PositionError raw = MeanPositionError(moved, truth);
  EXPECT_NEAR(raw.mean, 2, kTolerance);
  EXPECT_EQ(raw.missing, 18);
  EXPECT_EQ(raw.frames.missing, 1);
  const PositionError aligned = ProcrustesPositionError(moved, truth);
  EXPECT_NEAR(aligned.mean, 0, 1e-11);
  EXPECT_EQ(aligned.missing, 18);
  const MatrixX3d roots = RootPositions(moved, {4});
  EXPECT_TRUE(std::isnan(roots(1, 2)) && std::isnan(roots(2, 0)) && !std::isnan(roots(0, 0)));
}

TEST(MetricsTest, RootErrorKeepsDepthApart) {
  MatrixX3d truth = MatrixX3d::Zero(3, 3), estimate = truth;
  estimate.row(0) << 3, 4, 12;
  estimate.row(1) << 0, 0, -1;
  estimate.row(2).setConstant(kNotMeasured);
  const RootError e = RootPositionError(estimate, truth);
  EXPECT_DOUBLE_EQ(e.distance.mean, 7);
  EXPECT_DOUBLE_EQ(e.lateral, 2.5);
  EXPECT_DOUBLE_EQ(e.depth, 6.5);
  EXPECT_EQ(e.distance.missing, 1);
}

TEST(MetricsTest, DerivativesOfACubicAtIrregularTimes) {
  const std::vector<double> times = {0, 0.1, 0.15, 0.3, 0.32, 0.45};
  std::vector<MatrixX3d> clip;
  for (double t : times) {
    MatrixX3d frame(1, 3);
    frame << 2 * t, 3 * t * t, 4 * t * t * t;
    clip.push_back(frame);
  }
  for (const MatrixX3d& x : TimeDerivative(clip, times, 3, 1)) {
    EXPECT_NEAR(x(0, 0), 0, 1e-9);
    EXPECT_NEAR(x(0, 1), 0, 1e-9);
    EXPECT_NEAR(x(0, 2), 24, 1e-9);
  }
  const std::vector<MatrixX3d> second = TimeDerivative(clip, times, 2, 1);
  ASSERT_EQ(second.size(), 4u);
  for (const MatrixX3d& x : second) EXPECT_NEAR(x(0, 1), 6, 1e-10);
  EXPECT_NEAR(Jitter(clip, times, 1), 24, 1e-9);
}

TEST(MetricsTest, ConstantAccelerationAndFrameRate) {
  for (double fps : {30.0, 60.0}) {
    const std::vector<double> times = Times(20, fps);
    std::vector<MatrixX3d> still, falling;
    for (double t : times) {
      MatrixX3d frame = MatrixX3d::Ones(2, 3);
      still.push_back(frame);
      frame.row(0).y() += 0.5 * 9.81 * t * t;
      falling.push_back(frame);
    }
    const MotionError e = AccelerationError(falling, still, times);
    EXPECT_NEAR(e.mean, 9.81 / 2, 1e-9) << fps;  // one of two points
    EXPECT_NEAR(e.mean_prediction, 9.81 / 2, 1e-9);
    EXPECT_EQ(e.mean_truth, 0);
    EXPECT_EQ(e.count, 18 * 2);
    EXPECT_NEAR(Jitter(falling, times), 0, 1e-7);
  }
}

// A square wave of amplitude a: x_t = ±a gives |x″| = 4a fps² and |x‴| = 8a fps³ in every frame.
TEST(MetricsTest, AlternatingNoise) {
  std::vector<MatrixX3d> clip;
  clip.reserve(10);
  for (int t = 0; t < 10; ++t) clip.push_back(MatrixX3d::Constant(1, 3, t % 2 ? 0.01 : -0.01));
  const double a = 0.01 * std::sqrt(3.0);
  EXPECT_NEAR(Jitter(clip, Times(10, 60)), 8 * a * 216000, 1e-6);
  EXPECT_NEAR(AccelerationError(clip, std::vector<MatrixX3d>(10, MatrixX3d::Zero(1, 3)), Times(10, 60)).mean,
              4 * a * 3600, 1e-8);
}

TEST(MetricsTest, NothingIsDifferencedAcrossAGap) {
  std::vector<double> times = Times(10, 60);
  std::vector<MatrixX3d> clip(10, MatrixX3d::Zero(1, 3));
  for (int t = 5; t < 10; ++t) {
    times[t] += 1;          // a cut of one second
    clip[t](0, 0) = 100.0;  // after which the person stands elsewhere
  }
  const MotionError e = AccelerationError(clip, std::vector<MatrixX3d>(10, MatrixX3d::Zero(1, 3)), times);
  EXPECT_EQ(e.mean, 0);
  EXPECT_EQ(e.missing, 2);
  EXPECT_EQ(e.count, 6);
  EXPECT_EQ(Jitter(clip, times), 0);
  EXPECT_GT(Jitter(clip, times, 2.0), 1);  // unless requested
}

TEST(MetricsTest, ShortClipsHaveNoDerivative) {
  for (int T : {0, 1, 2}) {
    const std::vector<MatrixX3d> clip = RandomClip(T, 3, 7);
    EXPECT_TRUE(TimeDerivative(clip, Times(T, 60), 2).empty());
    EXPECT_TRUE(std::isnan(AccelerationError(clip, clip, Times(T, 60)).mean));
    EXPECT_TRUE(std::isnan(Jitter(clip, Times(T, 60))));
  }
}

TEST(MetricsTest, JointAnglesAreGeodesic) {
  const int J = 4;
  RowMatrixXd truth = RowMatrixXd::Zero(2, 3 * J), estimate = truth;
  const Eigen::Vector3d base(0.3, -1.2, 0.8), turn = 0.25 * Eigen::Vector3d(1, 2, -2) / 3;
  truth.row(0).segment<3>(3) = base.transpose();
  estimate.row(0).segment<3>(3) =
      AxisAngleFromRotation(RotationFromAxisAngle(base) * RotationFromAxisAngle(turn)).transpose();
  // The same rotation written with another turn of 2π is no error.
  truth.row(1).segment<3>(6) << std::numbers::pi - 0.1, 0, 0;
  estimate.row(1).segment<3>(6) << -std::numbers::pi - 0.1, 0, 0;
  estimate.row(0).head<3>() << 0, 0.5, 0;  // the root is kept apart
  const JointAngleError e = MeanJointAngleError(estimate, truth);
  const double turn_deg = 0.25 * 180 / std::numbers::pi;
  EXPECT_NEAR(e.mean_deg, turn_deg / 6, 1e-9);
  EXPECT_NEAR(e.per_joint_deg[1], turn_deg / 2, 1e-9);
  EXPECT_NEAR(e.per_joint_deg[2], 0, 1e-6);
  EXPECT_NEAR(e.root_deg, 0.25 * 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(e.count, 2 * J);

  estimate(1, 4) = kNotMeasured;
  const JointAngleError with_gap = MeanJointAngleError(estimate, truth);
  EXPECT_EQ(with_gap.missing, 1);
  EXPECT_NEAR(with_gap.per_joint_deg[1], turn_deg, 1e-9);
}

TEST(MetricsTest, BrokenContractsThrow) {
  const std::vector<MatrixX3d> a = RandomClip(3, 4, 8), b = RandomClip(2, 4, 8), c = RandomClip(3, 5, 8);
  EXPECT_THROW(MeanPositionError(a, b), std::invalid_argument);
  EXPECT_THROW(MeanPositionError(a, c), std::invalid_argument);
  EXPECT_THROW(ProcrustesPositionError(a, c), std::invalid_argument);
  EXPECT_THROW(ClipScale(a, b), std::invalid_argument);
  EXPECT_THROW(RootPositions(a, {4}), std::invalid_argument);
  EXPECT_THROW(RootPositions(a, {}), std::invalid_argument);
  EXPECT_THROW(RelativeTo(a, MatrixX3d::Zero(2, 3)), std::invalid_argument);
  EXPECT_THROW(RootPositionError(MatrixX3d::Zero(2, 3), MatrixX3d::Zero(3, 3)), std::invalid_argument);
  EXPECT_THROW(TimeDerivative(a, {0, 1}, 2), std::invalid_argument);
  EXPECT_THROW(TimeDerivative(a, {0, 1, 1}, 2), std::invalid_argument);
  EXPECT_THROW(TimeDerivative(a, {0, 1, kNotMeasured}, 2), std::invalid_argument);
  EXPECT_THROW(TimeDerivative(a, {0, 1, 2}, 4), std::invalid_argument);
  EXPECT_THROW(MeanJointAngleError(RowMatrixXd::Zero(2, 72), RowMatrixXd::Zero(2, 69)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::metrics_test
