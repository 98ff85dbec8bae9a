// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/motion_similarity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data_tools/body/builtin_body.h"
#include "tests/support/short_track.h"
namespace bodyloom::motion_similarity_test {
namespace {

TEST(MotionSimilarity, CorrelationIsPearsons) {
  DescriptorRows rows(4, 3);
  rows << 1, 2, 3, 10, 20, 30, 3, 2, 1, 5, 5, 5;
  const Eigen::MatrixXf c = NormalisedCrossCorrelation(rows, rows);
  EXPECT_NEAR(c(0, 1), 1, 1e-6);
  EXPECT_NEAR(c(0, 2), -1, 1e-6);
  EXPECT_EQ(c(0, 3), 0);
  EXPECT_THROW(NormalisedCrossCorrelation(rows, DescriptorRows(1, 2)), std::invalid_argument);
}

TEST(MotionSimilarity, IsOneForWhatWasSeenAndLessForWhatWasNot) {
  const Track track = ShortTrack(10);
  Track stiff = track;
  stiff.motion.poses.rightCols(stiff.motion.poses.cols() - 3) *= 0.3;
  const std::vector<float> own = SimilarityToNearest(BuiltinBody(), track, track, 3, 1);
  const std::vector<float> others = SimilarityToNearest(BuiltinBody(), track, stiff, 3, 1);
  ASSERT_EQ(own.size(), size_t(track.num_frames()));
  double mean = 0;
  for (size_t t = 0; t < own.size(); ++t) {
    EXPECT_NEAR(own[t], 1, 1e-4) << t;
    EXPECT_LE(others[t], 1 + 1e-4F) << t;
    mean += others[t] / static_cast<double>(own.size());
  }
  EXPECT_LT(mean, 0.999);
  EXPECT_GT(mean, 0.5);
}

TEST(MotionSimilarity, IsToTheFramesThatCount) {
  const Track track = ShortTrack(10);
  std::vector<char> counts(track.num_frames());
  for (int t = 0; t < 3; ++t) counts[t] = 1;
  const std::vector<float> to_all = SimilarityToNearest(BuiltinBody(), track, track, 2, 1);
  const std::vector<float> to_first = SimilarityToNearest(BuiltinBody(), track, track, 2, 1, {}, counts);
  float minimum = 1;
  for (int t = 0; t < track.num_frames(); ++t) {
    EXPECT_NEAR(to_all[t], 1, 1e-3);
    if (t < 3) {
      EXPECT_NEAR(to_first[t], 1, 1e-3);
    }
    minimum = std::min(minimum, to_first[t]);
  }
  EXPECT_LT(minimum, 0.9) << "the three frames of its beginning are not the whole motion";
  counts.assign(track.num_frames(), 0);
  EXPECT_TRUE(std::isnan(SimilarityToNearest(BuiltinBody(), track, track, 2, 1, {}, counts)[3]));
  counts.pop_back();
  EXPECT_THROW(SimilarityToNearest(BuiltinBody(), track, track, 2, 1, {}, counts), std::invalid_argument);
}

TEST(MotionSimilarity, FramesWithoutAResultHaveNone) {
  const Track whole = ShortTrack(10);
  Track track = whole;
  track.motion.trans.row(5).setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::vector<float> similarity = SimilarityToNearest(BuiltinBody(), track, whole, 2, 1);
  EXPECT_TRUE(std::isnan(similarity[5]));
  EXPECT_NEAR(similarity[15], 1, 1e-3);
}

}  // namespace
}  // namespace bodyloom::motion_similarity_test
