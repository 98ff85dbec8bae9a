// SPDX-License-Identifier: Apache-2.0
// Scores of the motion-dependent renderer on toy frames.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "neural/base/image_tensor.h"
#include "neural/motion/frame_tensors.h"
#include "neural/motion/motion_scorer.h"
#include "tests/neural/motion/toy_motion.h"

namespace bodyloom::motion_scorer_test {
namespace {

TEST(MotionScores, AreZeroForTheTruthAndWhatTheyShouldBeBesideIt) {
  const MotionConfig config = Toy();
  MotionScorer perfect(config), shifted(config);
  for (int t = 0; t < 3; ++t) {
    MotionFrame frame;
    ToyFrame(t, true, &frame);
    const MotionTruth truth = TruthOf(std::span(&frame, 1), config);
    MotionState state = truth.State(config);
    perfect.Add(state, truth, 0, 0);
    // Off by 0.1, 0.2, 0.3: the error of every frame, and by how much it changes.
    state.image = truth.image + 0.1 * (t + 1);
    state.labels = truth.labels.clone();
    state.labels.slice(1, 1, 2).fill_(2);  // everything is of class 1
    shifted.Add(state, truth, 0, 0);
  }
  EXPECT_EQ(perfect.Scores().image_l1, 0);
  EXPECT_EQ(perfect.Scores().label_iou, 1);
  EXPECT_EQ(perfect.Scores().foreground_iou, 1);
  EXPECT_NEAR(perfect.Scores().normal_deg, 0, 0.05);
  const MotionScores scores = shifted.Scores();
  EXPECT_NEAR(scores.image_l1, 0.2, 1e-6);
  EXPECT_NEAR(scores.flicker, 0.1, 1e-6);
  EXPECT_NEAR(scores.psnr_db, -10 * std::log10((0.01 + 0.04 + 0.09) / 3), 1e-4);
  EXPECT_NEAR(scores.class_iou[1], 128.0 / 1024, 1e-6);
  EXPECT_EQ(scores.class_iou[2], 0);
  EXPECT_NEAR(scores.foreground_iou, 256.0 / 1024, 1e-6);
  EXPECT_NEAR(scores.label_iou, 0.5 * 128 / 1024, 1e-6);
}

/// A still picture in a window that jumps, and one that is off by a constant: what the whole window's scores are of.
TEST(MotionScores, WholeWindowsAreComparedWhereTheyWere) {
  const MotionConfig config = Toy();
  const auto lpips = std::make_shared<const Lpips>(LpipsOptions{LpipsTrunk::kAlexNet, 16, 1});
  const auto share_of_equal_bytes = [](const Image& truth, const Image& result) {
    int equal = 0;
    for (size_t i = 0; i < truth.bgr.size(); ++i) equal += truth.bgr[i] == result.bgr[i];
    return static_cast<double>(equal) / static_cast<double>(truth.bgr.size());
  };
  MotionScorer still(config, {lpips, share_of_equal_bytes});
  for (int t = 0; t < 4; ++t) {  // the square moves right by one a frame: so does what it is seen through
    MotionFrame frame;
    ToyFrame(t, true, &frame);
    for (int y = 0; y < 32; ++y) {  // a pattern that is the square's own
      for (int x = 0; x < 32; ++x) {
        for (int c = 0; c < 3; ++c) {
          frame.image[c * 1024 + y * 32 + x] =
              frame.body[y * 32 + x] * static_cast<float>((5 * (x - t) + 3 * y + c) % 11) / 11;
        }
      }
    }
    const MotionTruth truth = TruthOf(std::span(&frame, 1), config);
    MotionState state = truth.State(config);
    state.image = 0.5 * truth.image;
    still.Add(state, truth, t > 0 ? 1 : 0, 0);
    EXPECT_GT(still.last().lpips, 0);
    EXPECT_GT(still.last().ssim, 0.5) << "the background is equal";
    EXPECT_LT(still.last().ssim, 1);
    EXPECT_EQ(std::isnan(still.last().tlpips), t == 0);
    EXPECT_NEAR(t > 0 ? still.last().tlpips : 0, 0, 1e-12);
  }
  const MotionScores scores = still.Scores();
  EXPECT_NEAR(scores.tlpips, 0, 1e-12);
  EXPECT_NEAR(scores.flicker, 0, 1e-6) << "aligned alike";
  EXPECT_NEAR(scores.ssim, still.last().ssim, 1e-3);
  EXPECT_TRUE(scores.lpips_random_features);
  // Not requested, not measured.
  EXPECT_TRUE(std::isnan(MotionScorer(config).Scores().ssim));
  EXPECT_TRUE(std::isnan(MotionScorer(config).Scores().lpips));
}

}  // namespace
}  // namespace bodyloom::motion_scorer_test
