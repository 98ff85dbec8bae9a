// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/motion_offsets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "bodyloom/render/avatar/skin_gaussians.h"
#include "tests/render/splat/same_bytes.h"
#include "tests/support/toy_body.h"

namespace bodyloom {
namespace {

constexpr int kSide = 64, kChannels = 32;

const GaussianBody& Person() {
  static const GaussianBody person = [] {
    const Eigen::VectorXd betas = Eigen::VectorXd::Zero(2);
    GaussianBody body =
        SkinGaussians(ToyBody(), betas, BuildUvTexelTable(ToyBody(), {.width = 40, .height = 40, .gutter = 0}));
    for (int i = 0; i < body.size(); ++i) body.kinds[i] = static_cast<GaussianKind>(i % 3);
    return body;
  }();
  return person;
}

float PositionLimit(const MotionLimits& limits, GaussianKind kind) {
  if (kind == GaussianKind::kCloth) return limits.cloth_position;
  return kind == GaussianKind::kLoose ? limits.loose_position : limits.skin_position;
}

TexelFeatures RandomMap(uint32_t seed) {
  std::mt19937 numbers(seed);
  TexelFeatures map(kSide, kChannels);
  for (int y = 0; y < kSide; ++y) {
    for (int i = 0; i < kSide * kChannels; ++i) map.at(y, 0)[i] = float(numbers() / 2147483648.0 - 1);
  }
  return map;
}

TEST(MotionOffsets, AConstantMapGivesEverybodyTheSame) {
  MotionOffsets offsets(ToyBody(), kSide);
  offsets.Anchor(Person());
  TexelFeatures map(kSide, kChannels);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int c = 0; c < kMotionChannels; ++c) map.at(y, x)[c] = c < 10 ? 1 : -3;
    }
  }
  GaussianOffsets found;
  offsets.Compute(map, 2, &found);
  const MotionLimits limits;
  ASSERT_EQ(found.columns.rows(), Person().size());
  for (int i = 0; i < Person().size(); ++i) {
    const GaussianKind kind = Person().kinds[i];
    const float share = kind == GaussianKind::kSkin ? 0.5F : -0.75F;
    const float opacity = kind == GaussianKind::kCloth ? 0 : limits.opacity_logit;
    EXPECT_NEAR(found.columns(i, GaussianOffsets::kPosition + 1), share * PositionLimit(limits, kind), 1e-6);
    EXPECT_NEAR(found.columns(i, GaussianOffsets::kLogScale + 2), share * limits.log_scale, 1e-6);
    EXPECT_NEAR(found.columns(i, GaussianOffsets::kOpacityLogit), share * opacity, 1e-6);
    EXPECT_NEAR(found.columns(i, GaussianOffsets::kAlbedo), share * limits.albedo, 1e-6);
  }
}

TEST(MotionOffsets, NothingIsEverBeyondTheLimits) {
  MotionOffsets offsets(ToyBody(), kSide);
  offsets.Anchor(Person());
  TexelFeatures map = RandomMap(2);
  for (int y = 0; y < kSide; ++y) {
    for (int i = 0; i < kSide * kChannels; ++i) map.at(y, 0)[i] *= 1e30F;
  }
  GaussianOffsets found;
  offsets.Compute(map, 1, &found);
  for (int i = 0; i < Person().size(); ++i) {
    EXPECT_LE(std::abs(found.columns(i, 0)), PositionLimit({}, Person().kinds[i]));
    EXPECT_LE(std::abs(found.columns(i, GaussianOffsets::kAlbedo)), 0.3F);
  }
}

TEST(MotionOffsets, DerivativesAreThoseOfWhatIsLookedUp) {
  MotionOffsets offsets(ToyBody(), kSide);
  offsets.Anchor(Person());
  const TexelFeatures map = RandomMap(3), direction = RandomMap(4);
  std::mt19937 numbers(5);
  FloatColumns by_offsets(GaussianOffsets::kNumColumns, Person().size());
  for (int c = 0; c < GaussianOffsets::kNumColumns; ++c) {
    for (float& v : by_offsets.values(c)) v = float(numbers() / 2147483648.0 - 1);
  }
  const auto loss = [&](float step) {
    TexelFeatures moved(kSide, kChannels);
    for (int y = 0; y < kSide; ++y) {
      for (int i = 0; i < kSide * kChannels; ++i) moved.at(y, 0)[i] = map.at(y, 0)[i] + step * direction.at(y, 0)[i];
    }
    GaussianOffsets found;
    offsets.Compute(moved, 1, &found);
    double sum = 0;
    for (int c = 0; c < GaussianOffsets::kNumColumns; ++c) {
      for (int i = 0; i < Person().size(); ++i) sum += double(by_offsets(i, c)) * found.columns(i, c);
    }
    return sum;
  };
  TexelFeatures by_map;
  offsets.Back(map, by_offsets, 2, &by_map);
  double predicted = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int i = 0; i < kSide * kChannels; ++i) predicted += double(by_map.at(y, 0)[i]) * direction.at(y, 0)[i];
  }
  const double difference = (loss(1e-3F) - loss(-1e-3F)) / 2e-3;
  EXPECT_GT(std::abs(difference), 0.1);
  EXPECT_NEAR(predicted, difference, 2e-3 * std::abs(difference));
}

TEST(MotionOffsets, SameBytesForAnyThreads) {
  MotionOffsets offsets(ToyBody(), kSide);
  offsets.Anchor(Person());
  const TexelFeatures map = RandomMap(6);
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* table) {
    GaussianOffsets found;
    offsets.Compute(map, threads, &found);
    TexelFeatures by_map;
    offsets.Back(map, found.columns, threads, &by_map);
    *table = found.columns;
    for (int y = 0; y < kSide; ++y) {
      for (int i = 0; i < kSide * kChannels; ++i) (*table)((y * 31 + i) % table->rows(), 0) += by_map.at(y, 0)[i];
    }
  });
}

TEST(MotionOffsets, RefusesWhatDoesNotFit) {
  MotionOffsets offsets(ToyBody(), kSide);
  offsets.Anchor(Person());
  GaussianOffsets found;
  EXPECT_THROW(offsets.Compute(TexelFeatures(kSide, 16), 1, &found), std::invalid_argument);
  EXPECT_THROW(offsets.Compute(TexelFeatures(kSide / 2, kChannels), 1, &found), std::invalid_argument);
  TexelFeatures by_map;
  EXPECT_THROW(offsets.Back(RandomMap(1), FloatColumns(3, 5), 1, &by_map), std::invalid_argument);
  EXPECT_THROW(MotionOffsets(ToyBody(), kSide, {.albedo = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom
