// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/learned/pose_prior_learning.h"
#include "geometry/math/direction_bins.h"
#include "tests/support/toy_body.h"

namespace bodyloom::pose_prior_test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Poses around two known means: elbow bent by 0.5 and by 1.5 rad, in equal numbers of frames.
Motion TwoClusters(int frames, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 0.05);
  Motion motion;
  motion.body = "smpl";
  motion.poses = RowMatrixXd::NullaryExpr(frames, 72, [&]() { return normal(random); });
  motion.trans = MatrixX3d::Zero(frames, 3);
  for (int t = 0; t < frames; ++t) {
    motion.timestamps.push_back(t / 15.0);
    const double bend = t % 2 == 0 ? 0.5 : 1.5;
    motion.poses(t, 3 * 18 + 1) -= bend;  // left elbow flexes about −y
    motion.poses(t, 3 * 19 + 1) += bend;
  }
  return motion;
}

TEST(PosePriorLearning, RecoversTwoClustersAndTheirSpread) {
  LearnPosePriorOptions options;
  options.num_components = 2;
  options.shrinkage = 0;
  options.floor_rad = 0.001;
  const PosePrior prior = LearnPosePrior({TwoClusters(800, 1)}, ToyBody(), options);
  ASSERT_EQ(prior.num_components(), 2);
  ASSERT_EQ(prior.joints.size(), 21U);
  const auto elbow = std::find(prior.joints.begin(), prior.joints.end(), "l_elbow") - prior.joints.begin();
  double bends[2] = {-prior.means(0, 3 * elbow + 1), -prior.means(1, 3 * elbow + 1)};
  std::sort(bends, bends + 2);
  EXPECT_NEAR(bends[0], 0.5, 0.01);
  EXPECT_NEAR(bends[1], 1.5, 0.01);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(std::exp(prior.log_weights[k]), 0.5, 0.01);
    EXPECT_NEAR(std::sqrt(prior.covariances[k](3 * elbow, 3 * elbow)), 0.05, 0.005);
  }
}

TEST(PosePriorLearning, MirroringTwiceChangesNothingAndPriorIsSymmetric) {
  const VectorXd pose = VectorXd::LinSpaced(72, -1, 1);
  EXPECT_EQ(MirrorPose(ToyBody(), MirrorPose(ToyBody(), pose)), pose);
  const VectorXd mirrored = MirrorPose(ToyBody(), pose);
  EXPECT_EQ(mirrored[3 * 19], pose[3 * 18]);
  EXPECT_EQ(mirrored[3 * 19 + 1], -pose[3 * 18 + 1]);
  LearnPosePriorOptions options;
  options.num_components = 1;
  const PosePrior prior = LearnPosePrior({TwoClusters(100, 2)}, ToyBody(), options);
  const auto left = std::find(prior.joints.begin(), prior.joints.end(), "l_knee") - prior.joints.begin();
  const auto right = std::find(prior.joints.begin(), prior.joints.end(), "r_knee") - prior.joints.begin();
  EXPECT_NEAR(prior.means(0, 3 * left), prior.means(0, 3 * right), 1e-12);
  EXPECT_NEAR(prior.means(0, 3 * left + 1), -prior.means(0, 3 * right + 1), 1e-12);
}

TEST(PosePriorLearning, DirectionDensitiesIntegrateToOneAndPeakAtThePose) {
  const PosePrior prior = LearnPosePrior({TwoClusters(200, 3)}, ToyBody(), LearnPosePriorOptions());
  const double N = prior.num_directions;
  for (const RowMatrixXf* table : {&prior.arm_log_density, &prior.leg_log_density}) {
    const double mean = table->cast<double>().array().exp().sum() / (N * N);  // relative to uniform
    EXPECT_NEAR(mean, 1, 1e-4);
  }
  const DirectionBins bins(prior.num_directions);
  const int down = bins.Nearest({0, -1, 0}), up = bins.Nearest({0, 1, 0});
  EXPECT_GT(prior.leg_log_density(down, down), prior.leg_log_density(up, up) + 3);
}

TEST(PosePriorLearning, RefusesMotionsOfAnotherSkeleton) {
  Motion motion = TwoClusters(10, 4);
  motion.poses.conservativeResize(10, 66);
  EXPECT_THROW((void)LearnPosePrior({motion}, ToyBody(), LearnPosePriorOptions()), std::invalid_argument);
  EXPECT_THROW((void)LearnPosePrior({}, ToyBody(), LearnPosePriorOptions()), std::invalid_argument);
}

TEST(PosePriorFile, RoundTripAndGarbage) {
  const PosePrior prior = LearnPosePrior({TwoClusters(200, 5)}, ToyBody(), LearnPosePriorOptions());
  const std::string path =
      (std::filesystem::temp_directory_path() / ("prior_" + std::to_string(::getpid()) + ".npz")).string();
  WritePosePrior(path, prior);
  const PosePrior back = ReadPosePrior(path);
  EXPECT_EQ(back.joints, prior.joints);
  EXPECT_LT((back.means - prior.means).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((back.covariances[1] - prior.covariances[1]).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((back.arm_log_density - prior.arm_log_density).cwiseAbs().maxCoeff(), 1.0 / 32 + 1e-6);
  const std::string bytes = ReadFileBytes(path);
  std::filesystem::remove(path);
  int refused = 0;
  for (size_t n = 0; n < bytes.size(); n += bytes.size() / 97) {
    try {
      (void)ReadPosePriorBytes(bytes.substr(0, n), "cut.npz");
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("cut.npz"), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GE(refused, 97);
}

TEST(BuiltinPosePrior, IsAProperPriorOnTheBuiltinBody) {
  const PosePrior& prior = BuiltinPosePrior();
  EXPECT_EQ(prior.num_components(), 8);
  EXPECT_NEAR(prior.log_weights.array().exp().sum(), 1, 1e-5);
  for (const std::string& name : prior.joints) EXPECT_GE(BuiltinBody().FindJoint(name), 0) << name;
  for (const Eigen::MatrixXd& C : prior.covariances) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(C, Eigen::EigenvaluesOnly);
    EXPECT_GT(eigen.eigenvalues()[0], 1e-4);
  }
  // Arms hang, or are raised; they do not point through the body. Elbows bend forwards, not backwards.
  const DirectionBins bins(prior.num_directions);
  const int down = bins.Nearest({0.2, -1, 0}), forward = bins.Nearest({0, 0, 1}), backward = bins.Nearest({0, 0, -1});
  EXPECT_GT(prior.arm_log_density(down, forward), prior.arm_log_density(down, backward) + 1);
  EXPECT_GT(prior.leg_log_density(down, backward), prior.leg_log_density(down, forward) + 1);  // knees, the other way
}

TEST(DirectionBins, NearestIsWithinABinsWidth) {
  const DirectionBins bins(200);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d d = Vector3d{normal(random), normal(random), normal(random)}.normalized();
    worst = std::max(worst, std::acos(std::min(1.0, d.dot(bins.direction(bins.Nearest(d))))));
  }
  // A bin reaches 0.17 rad at its corners (2.4/√200), a cell of the cube map adds up to 0.06.
  EXPECT_LT(worst, 0.23);
  for (int i = 0; i < bins.size(); ++i) EXPECT_EQ(bins.Nearest(bins.direction(i)), i);
  EXPECT_EQ(bins.Nearest(Vector3d::Zero()), 0);
}

}  // namespace
}  // namespace bodyloom::pose_prior_test
