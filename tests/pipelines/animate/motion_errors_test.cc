// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/motion_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

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

}  // namespace
}  // namespace bodyloom::motion_errors_test
