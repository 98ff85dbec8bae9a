// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "pipelines/animate/motion_errors.h"

#include "tests/support/scratch_folder.h"
#include "tests/support/test_files.h"

namespace bodyloom::motion_errors_test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

TEST(MotionErrors, EveryScoreIsInTheFileAndInTheQuarters) {
  MotionErrors errors({0.5F, 0.25F, 1, 0.75F, kNone});
  for (int t = 0; t < 5; ++t) {
    MotionFrameScores scores;
    scores.image_l1 = 0.1 * t, scores.ssim = 1 - 0.1 * t, scores.lpips = 0.01 * t;
    if (t > 0) scores.tlpips = 0.001 * t;
    errors.Add(t, scores);
  }
  const ScratchFolder scratch;
  errors.WriteCsv(scratch / "frames.csv");
  EXPECT_EQ(FileBytes(scratch / "frames.csv"),
            "frame,image_l1,ssim,lpips,tlpips,similarity\n0,0,1,0,,0.5\n1,0.1,0.9,0.01,0.001,0.25\n"
            "2,0.2,0.8,0.02,0.002,1\n3,0.3,0.7,0.03,0.003,0.75\n4,0.4,0.6,0.04,0.004,\n");
  const nlohmann::json json = ToJson(errors.Quarters());
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(json[0]["min_similarity"], 0.25);  // frame 1
  EXPECT_DOUBLE_EQ(json[0]["ssim"], 0.9);
  EXPECT_DOUBLE_EQ(json[0]["lpips"], 0.01);
  EXPECT_DOUBLE_EQ(json[0]["tlpips"], 0.001);
  EXPECT_TRUE(std::isnan(json[1]["tlpips"].get<double>())) << "frame 0 follows none";
  EXPECT_NE(json.dump().find("\"tlpips\":null"), std::string::npos);
}

// The scores of a run in one line.

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

}  // namespace bodyloom::motion_errors_test
