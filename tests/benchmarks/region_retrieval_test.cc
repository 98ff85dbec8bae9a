// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/region_retrieval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "geometry/scene/observations.h"
#include "tests/benchmarks/short_turning_clip.h"

namespace bodyloom::region_retrieval_test {
namespace {

TEST(RegionRetrieval, RegionsAreDisjointPartsOfTheAtlas) {
  std::vector<int> owners(24 * 24, 0);
  for (const RetrievedRegion where : {RetrievedRegion::kHand, RetrievedRegion::kTorso, RetrievedRegion::kLeg}) {
    const RegionOfBody region = MakeRegion(BuiltinBody(), where, 24);
    const auto size = std::count(region.texels.begin(), region.texels.end(), true);
    EXPECT_GT(size, 10) << RegionName(where);
    EXPECT_LT(size, 24 * 24 / 2) << RegionName(where);
    for (size_t i = 0; i < owners.size(); ++i) owners[i] += region.texels[i] ? 1 : 0;
  }
  EXPECT_EQ(*std::max_element(owners.begin(), owners.end()), 1);
}

TEST(RegionRetrieval, RowsAreTheRegionsColumnsOfTheWhole) {
  const TurningPerson person = ShortTurningClip(0, 60);
  const PersonFrames frames(BuiltinBody(), person.track, SmallFrames(64));
  const RegionOfBody hand = MakeRegion(BuiltinBody(), RetrievedRegion::kHand, 24);
  const DescriptorRows points = KeypointTrajectories(BuiltinBody(), person.track, 3, 0, 1);
  const DescriptorRows of_hand = KeypointsOfRegion(points, hand);
  ASSERT_EQ(of_hand.cols(), 2 * 2 * 3);
  const auto wrist = std::find(CocoNames().begin(), CocoNames().end(), "right_wrist") - CocoNames().begin();
  EXPECT_EQ(of_hand(7, 0), points(7, 2 * wrist));
  EXPECT_EQ(of_hand(7, 5), points(7, 2 * 17 + 2 * wrist + 1)) << "the frame before";
  const DescriptorRows motion = MotionDescriptors(frames, 2);
  EXPECT_EQ(MotionOfRegion(motion, hand).cols(), 9 * std::count(hand.texels.begin(), hand.texels.end(), true));
  EXPECT_THROW(MotionOfRegion(motion.leftCols(100), hand), std::invalid_argument);
  // The dense coordinates of a region equal the whole's where they are kept.
  const DescriptorRows whole = DenseCoordinates(frames, 3), part = DenseCoordinatesOfRegion(frames, hand, 3);
  ASSERT_EQ(part.cols(), whole.cols());
  int kept = 0;
  for (Eigen::Index t = 0; t < whole.rows(); ++t) {
    for (Eigen::Index i = 0; i < whole.cols(); ++i) {
      if (part(t, i) == 0) continue;
      ASSERT_EQ(part(t, i), whole(t, i)) << t << " " << i;
      ++kept;
    }
  }
  EXPECT_GT(kept, 100);
}

TEST(RegionRetrieval, ATurnHidesTheHandBehindTheBody) {
  const RegionOfBody hand = MakeRegion(BuiltinBody(), RetrievedRegion::kHand, 24);
  const TurningPerson facing = ShortTurningClip(0, 5), turning = ShortTurningClip(0, 90);
  const PersonFrames little(BuiltinBody(), facing.track, SmallFrames(64)),
      far(BuiltinBody(), turning.track, SmallFrames(64));
  const std::vector<bool> always = RegionSeen(little, hand, 1), at_times = RegionSeen(far, hand, 1),
                          longer = RegionSeen(far, hand, 10);
  EXPECT_EQ(std::count(always.begin(), always.end(), false), 0);
  const auto hidden = std::count(at_times.begin(), at_times.end(), false);
  EXPECT_GT(hidden, 10);
  EXPECT_GT(std::count(longer.begin(), longer.end(), false), hidden) << "a past that holds a hidden frame";
  for (size_t t = 0; t < at_times.size(); ++t) {
    if (!at_times[t]) {
      EXPECT_GT(std::abs(turning.yaw_deg[t]), 45) << t;
    }
  }
}

TEST(RegionRetrieval, FramesThatSayNothingAreNeitherAskedNorFound) {
  const TurningPerson person = ShortTurningClip(0, 60);
  const PersonFrames frames(BuiltinBody(), person.track, SmallFrames(64));
  const DescriptorRows motion = MotionDescriptors(frames, 10);
  std::vector<bool> defined(size_t(person.track.num_frames()), true);
  EXPECT_NEAR(ScoreRetrieval(person, motion, defined).answered_share, 1, 1e-12);
  const std::vector<int> queries = TurningFrames(person, false);
  for (size_t i = 0; i < queries.size() / 2; ++i) defined[size_t(queries[i])] = false;
  const RetrievalScores half = ScoreRetrieval(person, motion, defined);
  const size_t answered = queries.size() - queries.size() / 2;
  EXPECT_NEAR(half.answered_share, double(answered) / double(queries.size()), 1e-12);
  EXPECT_NEAR(half.direction_share, 1, 1e-12);
  EXPECT_THROW(ScoreRetrieval(person, motion, std::vector<bool>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::region_retrieval_test
