// SPDX-License-Identifier: Apache-2.0
// The scores of a run in one line.
#include "bodyloom/pipelines/people/motion_scores_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace bodyloom {
namespace {

TEST(MotionScoresText, LeavesOutWhatWasNotMeasured) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  MotionScores scores;
  scores.image_l1 = 0.05164, scores.psnr_db = 20.414, scores.label_iou = 0.8472, scores.foreground_iou = 0.912;
  scores.normal_deg = 25.31, scores.flicker = 0.0368;
  EXPECT_EQ(ScoresText(scores),
            "L1 0.0516, PSNR 20.41 dB, labels IoU 0.847, silhouette IoU 0.912, normals 25.3 deg, flicker 0.0368");
  scores.label_iou = scores.foreground_iou = scores.normal_deg = kNone;
  EXPECT_EQ(ScoresText(scores), "L1 0.0516, PSNR 20.41 dB, flicker 0.0368");
  scores.image_l1 = kNone;
  EXPECT_EQ(ScoresText(scores), "PSNR 20.41 dB, flicker 0.0368");
}

}  // namespace
}  // namespace bodyloom
