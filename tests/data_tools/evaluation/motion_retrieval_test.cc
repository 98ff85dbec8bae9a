// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/motion_retrieval.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "data_tools/body/builtin_body.h"
#include "tests/data_tools/evaluation/short_turning_clip.h"

namespace bodyloom::motion_retrieval_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(TurningPerson, TurnsThereAndBack) {
  const TurningPerson person = ShortTurningClip(0);
  ASSERT_EQ(person.track.num_frames(), 4 * 32);
  for (int t = 0; t < person.track.num_frames(); ++t) {
    EXPECT_EQ(person.cycle[t], t / 32 - 1);
    EXPECT_NEAR(person.yaw_deg[t], 60 * std::cos(2 * M_PI * t / 32), 1e-9);
    EXPECT_NEAR(person.yaw_rate_deg_s[t], -60 * 2 * M_PI / 1.6 * std::sin(2 * M_PI * t / 32), 1e-9);
  }
}

TEST(MotionRetrieval, CorrelationIsPearsons) {
  DescriptorRows rows(4, 3);
  rows << 1, 2, 3, 10, 20, 30, 3, 2, 1, 5, 5, 5;
  const Eigen::MatrixXf c = NormalisedCrossCorrelation(rows, rows);
  EXPECT_NEAR(c(0, 1), 1, 1e-6);
  EXPECT_NEAR(c(0, 2), -1, 1e-6);
  EXPECT_EQ(c(0, 3), 0);
  EXPECT_THROW(NormalisedCrossCorrelation(rows, DescriptorRows(1, 2)), std::invalid_argument);
}

TEST(MotionRetrieval, PeaksAreTheLargestOfTheirSurroundings) {
  const std::vector<float> curve = {0.95F, 0, 1, 0.9F, 0, 0.95F, 0.95F, 0, 0.5F, 0, 0.92F};
  EXPECT_THAT(Peaks(curve, 0.9, 1), ElementsAre(2, 5));
  EXPECT_THAT(Peaks(curve, 0.9, 3), ElementsAre(2));
  EXPECT_THAT(Peaks({}, 0.9, 1), IsEmpty());
}

TEST(MotionRetrieval, OnlyTheMotionDescriptorHasOnePeakACycle) {
  const TurningPerson person = ShortTurningClip(0);
  const PersonFrames frames(BuiltinBody(), person.track, SmallFrames(32));
  const RetrievalScores motion = ScoreRetrieval(person, MotionDescriptors(frames, 10));
  EXPECT_NEAR(motion.one_peak_share, 1, 1e-12);
  EXPECT_NEAR(motion.peaks_a_cycle, 1, 1e-12);
  EXPECT_NEAR(motion.direction_share, 1, 1e-12);
  const RetrievalScores keypoints = ScoreRetrieval(person, KeypointTrajectories(BuiltinBody(), person.track, 10, 0, 1));
  EXPECT_GT(keypoints.peaks_a_cycle, 1.5);
  const RetrievalScores dense = ScoreRetrieval(person, DenseCoordinates(frames, 1));
  EXPECT_GT(dense.peaks_a_cycle, 1.5);
  // Normals alone do not know the direction either.
  EXPECT_GT(ScoreRetrieval(person, MotionDescriptors(frames, 0)).peaks_a_cycle, 1.5);
}

TEST(MotionRetrieval, FindsTheDirectionInCyclesThatDiffer) {
  const TurningPerson person = ShortTurningClip(0.1);
  const PersonFrames frames(BuiltinBody(), person.track, SmallFrames(32));
  EXPECT_GT(ScoreRetrieval(person, MotionDescriptors(frames, 10)).direction_share, 0.99);
  EXPECT_LT(ScoreRetrieval(person, DenseCoordinates(frames, 1)).direction_share, 0.85);
}

TEST(MotionSimilarity, IsOneForWhatWasSeenAndLessForWhatWasNot) {
  const TurningPerson person = ShortTurningClip(0), other = ShortTurningClip(0.3);
  const std::vector<float> own = SimilarityToNearest(BuiltinBody(), person.track, person.track, 3, 1);
  const std::vector<float> others = SimilarityToNearest(BuiltinBody(), person.track, other.track, 3, 1);
  ASSERT_EQ(own.size(), size_t(person.track.num_frames()));
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
  const Track track = ShortTurningClip(0).track;
  std::vector<char> counts(track.num_frames());
  for (int t = 0; t < 10; ++t) counts[t] = 1;
  const std::vector<float> to_all = SimilarityToNearest(BuiltinBody(), track, track, 2, 1);
  const std::vector<float> to_first = SimilarityToNearest(BuiltinBody(), track, track, 2, 1, {}, counts);
  float least = 1;
  for (int t = 0; t < track.num_frames(); ++t) {
    EXPECT_NEAR(to_all[t], 1, 1e-3);
    if (t < 10) {
      EXPECT_NEAR(to_first[t], 1, 1e-3);
    }
    least = std::min(least, to_first[t]);
  }
  EXPECT_LT(least, 0.9) << "the ten frames of its beginning are not the whole motion";
  counts.assign(track.num_frames(), 0);
  EXPECT_TRUE(std::isnan(SimilarityToNearest(BuiltinBody(), track, track, 2, 1, {}, counts)[3]));
  counts.pop_back();
  EXPECT_THROW(SimilarityToNearest(BuiltinBody(), track, track, 2, 1, {}, counts), std::invalid_argument);
}

TEST(MotionSimilarity, FramesWithoutAResultHaveNone) {
  TurningPerson person = ShortTurningClip(0);
  const Track whole = person.track;
  person.track.motion.trans.row(5).setConstant(std::numeric_limits<double>::quiet_NaN());
  const std::vector<float> similarity = SimilarityToNearest(BuiltinBody(), person.track, whole, 2, 1);
  EXPECT_TRUE(std::isnan(similarity[5]));
  EXPECT_NEAR(similarity[20], 1, 1e-3);
}

}  // namespace
}  // namespace bodyloom::motion_retrieval_test
