// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/motion_retrieval.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "data_tools/body/builtin_body.h"
#include "tests/benchmarks/short_turning_clip.h"

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

}  // namespace
}  // namespace bodyloom::motion_retrieval_test
