// SPDX-License-Identifier: Apache-2.0
// The scores of a run in one line.
#include "pipelines/animate/motion_errors.h"

#include <gtest/gtest.h>

#include <limits>

namespace bodyloom::motion_scores_text_test {
namespace {

TEST(MotionScoresText, LeavesOutWhatWasNotMeasured) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  MotionScores scores;
  scores.ssim = scores.lpips = scores.tlpips = kNone;
  scores.image_l1 = 0.05164, scores.psnr_db = 20.414, scores.label_iou = 0.8472, scores.foreground_iou = 0.912;
  scores.normal_deg = 25.31, scores.flicker = 0.0368;
  EXPECT_EQ(ScoresText(scores),
            "L1 0.0516, PSNR 20.41 dB, labels IoU 0.847, silhouette IoU 0.912, normals 25.3 deg, flicker 0.0368");
  scores.label_iou = scores.foreground_iou = scores.normal_deg = kNone;
  EXPECT_EQ(ScoresText(scores), "L1 0.0516, PSNR 20.41 dB, flicker 0.0368");
  scores.image_l1 = kNone;
  EXPECT_EQ(ScoresText(scores), "PSNR 20.41 dB, flicker 0.0368");
}

TEST(MotionScoresText, NamesTheNetworkThatMeasures) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  MotionScores scores;
  scores.image_l1 = scores.label_iou = scores.foreground_iou = scores.normal_deg = scores.flicker = kNone;
  scores.psnr_db = 20;
  scores.ssim = 0.93124, scores.lpips = 0.03871, scores.tlpips = 0.001234;
  EXPECT_EQ(ScoresText(scores),
            "PSNR 20.00 dB, SSIM 0.9312, LPIPS (random features) 0.0387, tLPIPS (random features) 0.00123");
  scores.lpips_random_features = false;
  EXPECT_EQ(ScoresText(scores), "PSNR 20.00 dB, SSIM 0.9312, LPIPS 0.0387, tLPIPS 0.00123");
  MotionFrameScores frame;
  frame.image_l1 = 0.05, frame.ssim = 0.9;
  EXPECT_EQ(ScoresText(frame, true), "L1 0.0500, SSIM 0.9000");
}

}  // namespace
}  // namespace bodyloom::motion_scores_text_test
