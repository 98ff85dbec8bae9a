// SPDX-License-Identifier: Apache-2.0
// Long clips: shape and focal length from a sample of the coarse frames, then windows.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/base/percentile.h"
#include "geometry/scene/track.h"
#include "tests/support/clip_input.h"
#include "tests/support/sequence_scene.h"
#include "tracking/clip/clip_fit.h"
#include "tracking/clip/uncertainty.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom::long_clip_test {
namespace {

std::unique_ptr<SequenceScene> LongScene(int frames) {
  SequenceSceneOptions options;
  options.frames = frames;
  options.dense = 0;
  options.knowledge = CameraKnowledge::kUnknownFocal;
  return MakeSequenceScene(options);
}

SolveOptions ManySteps() {
  SolveOptions options;
  options.solver = SequenceSolver::kChain;
  options.num_threads = 2;
  options.max_iterations = 40;
  options.function_tolerance = 1e-7;
  return options;
}

TEST(LongClip, StretchesLieEvenlyOverIt) {
  const std::vector<char> used = StretchesOf(1000, 200);
  int count = 0;
  for (size_t t = 0; t < used.size(); ++t) {
    count += used[t];
    EXPECT_EQ(used[t] != 0, t % 250 < 50) << t;
  }
  EXPECT_EQ(count, 200);
}

TEST(LongClip, ASampleTellsWhatAllFramesShare) {
  const auto scene = LongScene(450);
  SequenceProblem& whole = scene->problem;
  // A strong prior on a wrong focal length: it must not weigh more than for the whole clip.
  whole.log_focal_prior += 0.2;
  whole.log_focal_sigma = 0.02;
  whole.shape_prior.weight = 20;
  SequenceSample sample(whole, 150);
  EXPECT_EQ(sample.frames.size(), 150U);
  EXPECT_DOUBLE_EQ(sample.share, 1.0 / 3);
  SolveSequence(&whole, ManySteps());
  SolveSequence(&sample.part, ManySteps());
  EXPECT_GT(std::abs(whole.log_focal - std::log(1000)), 0.01);  // the prior does pull
  EXPECT_NEAR(sample.part.log_focal, whole.log_focal, 0.01);
  EXPECT_LT((sample.part.betas - whole.betas).norm(), 0.1 * whole.betas.norm());
  const double sigma = FocalLogSigmaOf(whole, 2);
  EXPECT_NEAR(std::sqrt(sample.share) * FocalLogSigmaOf(sample.part, 2), sigma, 0.1 * sigma);
}

TEST(LongClip, ASampleKeepsShotsAndCutsItsStretches) {
  const auto scene = LongScene(400);
  SequenceProblem& problem = scene->problem;
  problem.cut_before[120] = problem.cut_before[210] = 1;  // in a stretch that is left out, and in one that is used
  problem.smoothness.assign(3, Smoothness());
  for (int shot = 0; shot < 3; ++shot) problem.smoothness[shot].tip_acceleration = 10 * (shot + 1);
  const SequenceSample sample(problem, 100);
  ASSERT_EQ(sample.frames.size(), 100U);
  ASSERT_EQ(sample.frames[50], 200);
  for (size_t i = 0; i < sample.frames.size(); ++i) {
    EXPECT_EQ(sample.part.cut_before[i] != 0, i == 50 || i == 60) << i;
    EXPECT_EQ(sample.part.timestamps[i], problem.timestamps[sample.frames[i]]);
  }
  ASSERT_EQ(sample.part.smoothness.size(), 3U);
  for (int shot = 0; shot < 3; ++shot) EXPECT_EQ(sample.part.smoothness[shot].tip_acceleration, 10 * (shot + 1));
}

TEST(LongClip, SigmaInWindowsIsThatOfTheWhole) {
  const auto scene = LongScene(500);
  double focal = 0, focal_in_windows = 0;
  const PositionSigma whole = PositionSigmaOf(scene->problem, 2, &focal);
  const PositionSigma windows = PositionSigmaInWindows(scene->problem, 200, 2, &focal_in_windows);
  EXPECT_NEAR(focal_in_windows, focal, 0.1 * focal);
  ASSERT_EQ(windows.joints.rows(), 500);
  // The first of the body's joints lies in the middle of the hips.
  EXPECT_LT((windows.joints - whole.joints).cwiseAbs().maxCoeff(), 0.05 * whole.joints.maxCoeff());
  const Eigen::ArrayXd of_hips = windows.hips.array() / whole.hips.array() - 1;
  EXPECT_LT(of_hips.abs().maxCoeff(), 0.1);
  const PositionSigma same = PositionSigmaInWindows(scene->problem, 200, 3);
  EXPECT_EQ(same.joints, windows.joints);
  EXPECT_EQ(same.hips, windows.hips);
}

TrackSequenceResult FitUnknownFocal(const SynthClip& clip) {
  TrackSequenceOptions options = UnknownFocalOptions();
  options.solver = SequenceSolver::kChain;
  return FitClip(UnknownFocalInput(clip), options);
}

TEST(LongClip, IsTrackedAsItsBeginningIs) {
  constexpr int kWhole = 1980;  // solved at once
  SynthClipOptions synth;
  synth.dense_per_frame = 0;
  synth.camera.width = 240;  // the truth's visibility is rendered for each frame
  synth.camera.height = 180;
  SynthClip clip = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 2100, 15), synth);
  const TrackSequenceResult in_windows = FitUnknownFocal(clip);
  clip.keypoints.timestamps.resize(kWhole);
  clip.keypoints.points.resize(kWhole * clip.keypoints.names.size());
  const TrackSequenceResult whole = FitUnknownFocal(clip);
  ASSERT_TRUE(in_windows.summary.IsUsable() && whole.summary.IsUsable());
  EXPECT_NEAR(std::log(in_windows.summary.focal_px), std::log(whole.summary.focal_px), 0.01);
  EXPECT_NEAR(in_windows.summary.focal_log_sigma, whole.summary.focal_log_sigma, 0.05 * whole.summary.focal_log_sigma);
  EXPECT_LT((in_windows.track.motion.betas - whole.track.motion.betas).norm(), 0.2);
  std::vector<double> moved, sigma_ratio;
  for (int t = 0; t < kWhole - 50; ++t) {
    const MatrixX3d difference = in_windows.track.joints[t] - whole.track.joints[t];
    moved.push_back((difference.rowwise() - difference.row(0)).rowwise().norm().maxCoeff());
    sigma_ratio.push_back(in_windows.track.joint_sigma.row(t).mean() / whole.track.joint_sigma.row(t).mean());
  }
  EXPECT_LT(Percentile(moved, 50), 0.01);
  EXPECT_LT(Percentile(moved, 99), 0.1);
  EXPECT_NEAR(Percentile(sigma_ratio, 50), 1, 0.02);
}

}  // namespace
}  // namespace bodyloom::long_clip_test
