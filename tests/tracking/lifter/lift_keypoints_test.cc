// SPDX-License-Identifier: Apache-2.0
// From 2D landmarks to lifted frames: phases, mirror, cuts, the mean of hypotheses, unusual clips. The network is
// random here; its predictions are tested elsewhere.
#include "tracking/lifter/lift_keypoints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "tests/support/toy_body.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/lifter/lifter_input.h"

namespace bodyloom::lift_keypoints_test {
namespace {

LifterWeights RandomWeights(uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  const auto fill = [&](auto* array, Eigen::Index rows, Eigen::Index cols, float size) {
    array->resize(rows, cols);
    for (Eigen::Index i = 0; i < array->size(); ++i) array->data()[i] = size * normal(random);
  };
  constexpr int C = 12;
  LifterWeights weights;
  fill(&weights.input, C, 3 * kLifterInputs, 0.2F);
  fill(&weights.input_bias, C, 1, 0.1F);
  for (const int dilation : {1, 2}) {
    LifterWeights::Block& block = weights.blocks.emplace_back();
    block.dilation = dilation;
    block.norm_scale = Eigen::VectorXf::Ones(C);
    block.norm_shift = Eigen::VectorXf::Zero(C);
    fill(&block.dilated, C, 3 * C, 0.2F);
    fill(&block.dilated_bias, C, 1, 0.1F);
    fill(&block.mix, C, C, 0.2F);
    fill(&block.mix_bias, C, 1, 0.1F);
  }
  weights.norm_scale = Eigen::VectorXf::Ones(C);
  weights.norm_shift = Eigen::VectorXf::Zero(C);
  fill(&weights.output, LifterOutput::kSize, C, 0.2F);
  fill(&weights.output_bias, LifterOutput::kSize, 1, 0.2F);
  return weights;
}

const Camera kCamera = MakePinhole(1000, 800, 900);

/// A person of 300 px waving about.
KeypointSequence Wave(int frames, double fps) {
  KeypointSequence keypoints;
  keypoints.names = CocoNames();
  keypoints.image_width = 1000;
  keypoints.image_height = 800;
  const MatrixX3d rest = [] {
    BodyPose pose;
    const BodyModel body{ToyBodyData()};
    pose.rotations.assign(body.num_joints(), Eigen::Matrix3d::Identity());
    return PoseLandmarks(body, Eigen::VectorXd(), pose, CocoNames());
  }();
  for (int t = 0; t < frames; ++t) {
    const double s = t / fps;
    keypoints.timestamps.push_back(s);
    for (int k = 0; k < 17; ++k) {
      const double sway = 12 * std::sin(2 * s + 0.7 * k);
      keypoints.points.push_back({static_cast<float>(499.5 + 160 * rest(k, 0) + sway),
                                  static_cast<float>(399.5 - 160 * rest(k, 1) + 0.5 * sway), 0.8F});
    }
  }
  return keypoints;
}

bool AllFinite(const std::vector<LiftedFrame>& frames) {
  for (const LiftedFrame& frame : frames) {
    if (!frame.points.allFinite() || !frame.sigma.allFinite() || !frame.up.allFinite()) return false;
    if (!(frame.sigma.minCoeff() > 0) || std::abs(frame.up.norm() - 1) > 1e-6) return false;
    for (const auto& limb : frame.limbs) {
      double sum = 0;
      for (const LiftedLimb& guess : limb) sum += guess.weight;
      if (std::abs(sum - 1) > 1e-6) return false;
    }
  }
  return true;
}

TEST(LiftKeypoints, AMirroredClipGivesTheMirroredAnswer) {
  const LifterWeights weights = RandomWeights(1);
  const KeypointSequence clip = Wave(40, 20);
  KeypointSequence mirrored = clip;
  for (int t = 0; t < clip.num_frames(); ++t) {
    for (int k = 0; k < 17; ++k) {
      const int from = k == 0 ? 0 : ((k - 1) ^ 1) + 1;
      mirrored.at(t, k) = clip.at(t, from);
      mirrored.at(t, k).x = 999 - clip.at(t, from).x;
    }
  }
  const auto a = LiftKeypoints(clip, kCamera, true, {}, weights, {});
  const auto b = LiftKeypoints(mirrored, kCamera, true, {}, weights, {});
  ASSERT_EQ(a.size(), 40U);
  ASSERT_TRUE(AllFinite(a));
  for (size_t t = 0; t < a.size(); ++t) {
    for (const int k : LifterOutput::kTorso) {
      const int from = k == 0 ? 0 : ((k - 1) ^ 1) + 1;
      EXPECT_NEAR(a[t].points(k, 0), -b[t].points(from, 0), 1e-4);
      EXPECT_NEAR(a[t].points(k, 2), b[t].points(from, 2), 1e-4);
    }
    EXPECT_NEAR(a[t].contact[0], b[t].contact[1], 1e-4);
  }
}

TEST(LiftKeypoints, PhasesOfAFastClipAreTheSlowClips) {
  const LifterWeights weights = RandomWeights(2);
  const KeypointSequence fast = Wave(90, 60);
  const auto all = LiftKeypoints(fast, kCamera, true, {}, weights, {});
  for (int phase = 0; phase < 3; ++phase) {
    KeypointSequence slow = fast;
    slow.points.clear();
    slow.timestamps.clear();
    for (int t = phase; t < 90; t += 3) {
      slow.timestamps.push_back(fast.timestamps[t]);
      for (int k = 0; k < 17; ++k) slow.points.push_back(fast.at(t, k));
    }
    const auto part = LiftKeypoints(slow, kCamera, true, {}, weights, {});
    for (int i = 0; i < 30; ++i) EXPECT_TRUE(part[i].points == all[phase + 3 * i].points);
  }
}

TEST(LiftKeypoints, OnePhaseFillsInBetween) {
  LiftOptions options;
  options.all_phases = false;
  const auto frames = LiftKeypoints(Wave(31, 60), kCamera, true, {}, RandomWeights(2), options);
  ASSERT_EQ(frames.size(), 31U);
  EXPECT_TRUE(AllFinite(frames));
  const MatrixX3d between = (2 * frames[3].points + frames[6].points) / 3;
  EXPECT_LT((frames[4].points - between).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(LiftKeypoints, ThreadsDoNotMatter) {
  LiftOptions one, many;
  many.num_threads = 5;
  const auto a = LiftKeypoints(Wave(100, 60), kCamera, false, {}, RandomWeights(3), one);
  const auto b = LiftKeypoints(Wave(100, 60), kCamera, false, {}, RandomWeights(3), many);
  for (size_t t = 0; t < a.size(); ++t) EXPECT_TRUE(a[t].points == b[t].points && a[t].sigma == b[t].sigma);
}

TEST(LiftKeypoints, ACutSeparatesTwoClips) {
  const LifterWeights weights = RandomWeights(4);
  const KeypointSequence clip = Wave(60, 20);
  std::vector<char> cuts(60, 0);
  cuts[25] = 1;
  const auto cut = LiftKeypoints(clip, kCamera, true, cuts, weights, {});
  KeypointSequence second = clip;
  second.points.erase(second.points.begin(), second.points.begin() + 25 * 17);
  second.timestamps.erase(second.timestamps.begin(), second.timestamps.begin() + 25);
  const auto alone = LiftKeypoints(second, kCamera, true, {}, weights, {});
  for (int t = 0; t < 35; ++t) EXPECT_TRUE(cut[25 + t].points == alone[t].points);
}

TEST(LiftKeypoints, OddClipsGiveFiniteAnswers) {
  const LifterWeights weights = RandomWeights(5);
  for (const double fps : {0.5, 5.0, 12.0, 15.0, 25.0, 240.0, 1000.0}) {
    for (const int frames : {1, 2, 3, 50}) {
      const auto result = LiftKeypoints(Wave(frames, fps), kCamera, true, {}, weights, {});
      ASSERT_EQ(result.size(), size_t(frames)) << fps;
      EXPECT_TRUE(AllFinite(result)) << fps << " " << frames;
    }
  }
  KeypointSequence one_joint = Wave(30, 20);
  for (int t = 0; t < 30; ++t) {
    for (int k = 1; k < 17; ++k) one_joint.at(t, k).confidence = 0;
  }
  EXPECT_TRUE(AllFinite(LiftKeypoints(one_joint, kCamera, true, {}, weights, {})));
  KeypointSequence wild = Wave(30, 20);
  wild.at(3, 5).x = std::numeric_limits<float>::quiet_NaN();
  wild.at(4, 5).confidence = 17;
  wild.at(5, 5).y = 1e30F;
  wild.at(6, 5).confidence = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(AllFinite(LiftKeypoints(wild, kCamera, true, {}, weights, {})));
  KeypointSequence nothing = Wave(30, 20);
  for (Keypoint& point : nothing.points) point.confidence = 0;
  EXPECT_TRUE(LiftKeypoints(nothing, kCamera, true, {}, weights, {}).empty());
}

TEST(LiftKeypoints, WeightsOfAnotherInputAreRefused) {
  LifterWeights weights = RandomWeights(6);
  weights.input.conservativeResize(Eigen::NoChange, 30);
  EXPECT_THROW(LiftKeypoints(Wave(3, 20), kCamera, true, {}, weights, {}), std::invalid_argument);
}

TEST(MeanLimb, WeighsTheGuessesAndCoversThem) {
  std::vector<LiftedLimb> guesses(2);
  const Eigen::Matrix3d R = RotationFromAxisAngle(Eigen::Vector3d(0.3, -0.4, 0.1));
  for (int m = 0; m < 2; ++m) {
    guesses[m].weight = m == 0 ? 0.75 : 0.25;
    guesses[m].points.fill(R * Eigen::Vector3d(0.1, 0.2, m == 0 ? 0.4 : -0.4));
    guesses[m].sigma.fill({0.1, 0.2});
  }
  const LiftedLimb mean = MeanLimb(guesses, R);
  EXPECT_DOUBLE_EQ(mean.weight, 1);
  EXPECT_LT((mean.points[1] - R * Eigen::Vector3d(0.1, 0.2, 0.2)).norm(), 1e-12);
  EXPECT_NEAR(mean.sigma[1][0], 0.1, 1e-12) << "they agree across the view";
  // Along it they are 0.2 and 0.6 from the mean: variance 0.75·0.04 + 0.25·0.36 = 0.12.
  EXPECT_NEAR(mean.sigma[1][1], std::sqrt(0.04 + 0.12 / 4), 1e-12);
  guesses.resize(1);
  guesses[0].weight = 1;
  EXPECT_LT((MeanLimb(guesses, R).points[0] - guesses[0].points[0]).norm(), 1e-12);
  EXPECT_LT((MeanLimb(guesses, R).sigma[0] - guesses[0].sigma[0]).norm(), 1e-12);
}

TEST(StartFromLifted, PlacesTheHipsWhereTheRaysMeet) {
  // Whatever the network predicts of the shape, the mid-hip is where it fits the image best: in front, near the middle.
  const BodyModel body{ToyBodyData()};
  const KeypointSequence clip = Wave(20, 20);
  LiftedStart start;
  start.frames = LiftKeypoints(clip, kCamera, true, {}, RandomWeights(7), {});
  StartFromLifted(clip, kCamera, body, Eigen::VectorXd(), &start);
  ASSERT_EQ(start.initial.states.size(), 20U);
  for (const FrameState& state : start.initial.states) {
    EXPECT_TRUE(state.translation.allFinite());
    BodyPose pose;
    pose.rotations = state.rotations;
    pose.trans = state.translation;
    const MatrixX3d hips = PoseLandmarks(body, Eigen::VectorXd(), pose, {"left_hip", "right_hip"});
    EXPECT_GT(hips.col(2).mean(), 0);
    for (const Eigen::Matrix3d& R : state.rotations)
      EXPECT_NEAR((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-9);
  }
  EXPECT_GT(start.metres, 0.5);
}

}  // namespace
}  // namespace bodyloom::lift_keypoints_test
