// SPDX-License-Identifier: Apache-2.0
// Points followed through pictures whose motion is known.
#include "tracking/detection/background_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

#include "geometry/base/percentile.h"

namespace bodyloom::background_tracker_test {
namespace {

constexpr int kWidth = 640, kHeight = 360;

/// Smooth blobs at random places: a picture that can be sampled anywhere.
class Blobs {
 public:
  explicit Blobs(uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    for (Blob& blob : blobs_) {
      blob.x = -300 + 1240 * uniform(random);
      blob.y = -300 + 960 * uniform(random);
      blob.size = 2 + 2.5 * uniform(random);
      blob.level = 200 * uniform(random) - 100;
    }
  }
  /// The picture moved by (dx, dy), with noise of some levels.
  [[nodiscard]] Image Picture(double dx, double dy, double noise = 0, uint64_t seed = 1) const {
    std::vector<double> grey(size_t(kWidth) * kHeight, 120);
    for (const Blob& blob : blobs_) {
      const double x = blob.x + dx, y = blob.y + dy;
      const int reach = static_cast<int>(4 * blob.size);
      for (int v = std::max(0, int(y) - reach); v < std::min(kHeight, int(y) + reach); ++v) {
        for (int u = std::max(0, int(x) - reach); u < std::min(kWidth, int(x) + reach); ++u) {
          const double r2 = ((u - x) * (u - x) + (v - y) * (v - y)) / (blob.size * blob.size);
          grey[size_t(v) * kWidth + u] += blob.level * std::exp(-0.5 * r2);
        }
      }
    }
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise > 0 ? noise : 1);
    Image image(kWidth, kHeight);
    for (size_t i = 0; i < grey.size(); ++i) {
      const double level = grey[i] + (noise > 0 ? normal(random) : 0);
      std::fill_n(image.bgr.begin() + std::ptrdiff_t(3 * i), 3, uint8_t(std::clamp(level + 0.5, 0.0, 255.0)));
    }
    return image;
  }

 private:
  struct Blob {
    double x = 0, y = 0, size = 0, level = 0;
  };
  std::vector<Blob> blobs_ = std::vector<Blob>(3000);
};

int NumSeen(const BackgroundTracks::Sight& sight) {
  return int(std::count_if(sight.pixels.begin(), sight.pixels.end(), [](const auto& p) { return p.allFinite(); }));
}

TEST(BackgroundTracker, PointsAreWhereThePictureWent) {
  const Blobs blobs(1);
  BackgroundTracker tracker;
  for (int t = 0; t < 12; ++t) tracker.Push(blobs.Picture(1.3 * t, -0.7 * t), t / 30.0, {});
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_EQ(tracks.anchors.size(), 1u);
  EXPECT_EQ(tracks.timestamps.size(), 12u);
  const BackgroundTracks::Anchor& anchor = tracks.anchors[0];
  EXPECT_GT(anchor.pixels.size(), 100u);
  ASSERT_EQ(anchor.sights.size(), 11u);
  for (const BackgroundTracks::Sight& sight : anchor.sights) {
    EXPECT_GT(NumSeen(sight), int(0.8 * double(anchor.pixels.size())));
    std::vector<double> off;
    for (size_t i = 0; i < sight.pixels.size(); ++i) {
      if (!sight.pixels[i].allFinite()) continue;
      const Eigen::Vector2f expected =
          anchor.pixels[i] + Eigen::Vector2f(1.3F * float(sight.frame), -0.7F * float(sight.frame));
      off.push_back((sight.pixels[i] - expected).norm());
    }
    EXPECT_LT(Percentile(off, 50), 0.1) << sight.frame;
    EXPECT_LT(Percentile(off, 95), 0.3) << sight.frame;
  }
}

TEST(BackgroundTracker, AStillClipIsLookedAtFiveTimesASecond) {
  const Blobs blobs(2);
  BackgroundTracker tracker;
  for (int t = 0; t < 61; ++t) tracker.Push(blobs.Picture(0, 0, 2, uint64_t(t)), t / 30.0, {});
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_EQ(tracks.anchors.size(), 1u);
  EXPECT_LE(tracks.anchors[0].sights.size(), 11u);
  EXPECT_GE(tracks.anchors[0].sights.size(), 9u);
  EXPECT_EQ(tracks.timestamps.size(), 61u);
}

TEST(BackgroundTracker, FramesBeforeAMotionWasNoticedAreLookedAtToo) {
  const Blobs blobs(3);
  BackgroundTracker tracker;
  constexpr int kRests = 40;
  for (int t = 0; t < 60; ++t) tracker.Push(blobs.Picture(std::max(0, t - kRests) * 1.5, 0), t / 30.0, {});
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_EQ(tracks.anchors.size(), 1u);
  std::vector<int> frames;
  for (const BackgroundTracks::Sight& sight : tracks.anchors[0].sights) frames.push_back(sight.frame);
  for (int t = kRests + 3; t < 60; ++t) EXPECT_EQ(std::count(frames.begin(), frames.end(), t), 1) << t;
}

TEST(BackgroundTracker, NobodysPointsAreFollowed) {
  const Blobs blobs(4);
  BackgroundTracker tracker;
  CoveredRegion box;
  box.x0 = 100, box.y0 = 50, box.x1 = 260, box.y1 = 300;
  CoveredRegion masked;
  masked.mask.x_begin = 400, masked.mask.y_begin = 100, masked.mask.width = 80, masked.mask.height = 150;
  masked.mask.labels.assign(80 * 150, 1);
  const std::vector<CoveredRegion> people = {box, masked};
  for (int t = 0; t < 4; ++t) {
    tracker.Push(blobs.Picture(2.0 * t, 0), t / 30.0, t < 2 ? std::vector<CoveredRegion>{box} : people);
  }
  const BackgroundTracks tracks = tracker.Finish();
  const auto inside = [](const Eigen::Vector2f& p, float x0, float y0, float x1, float y1) {
    return p.x() > x0 && p.x() < x1 && p.y() > y0 && p.y() < y1;
  };
  int in_mask = 0;
  for (const Eigen::Vector2f& p : tracks.anchors[0].pixels) {
    EXPECT_FALSE(inside(p, 101, 51, 259, 299));
    in_mask += inside(p, 400, 100, 480, 250) ? 1 : 0;
  }
  EXPECT_GT(in_mask, 5) << "nobody is there in the anchor's frame";
  for (const BackgroundTracks::Sight& sight : tracks.anchors[0].sights) {
    for (const Eigen::Vector2f& p : sight.pixels) {
      EXPECT_FALSE(sight.frame >= 2 && p.allFinite() && inside(p, 399, 99, 480, 250)) << sight.frame;
    }
  }
}

TEST(BackgroundTracker, NewAnchorsFollowWhatComesIntoView) {
  const Blobs blobs(5);
  BackgroundTracker tracker;
  for (int t = 0; t < 40; ++t) tracker.Push(blobs.Picture(-7.0 * t, 0), t / 30.0, {});
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_GE(tracks.anchors.size(), 2u);
  for (size_t k = 1; k < tracks.anchors.size(); ++k) {
    EXPECT_FALSE(tracks.anchors[k].after_break);
    const auto& sights = tracks.anchors[k - 1].sights;
    EXPECT_TRUE(std::any_of(sights.begin(), sights.end(),
                            [&](const auto& sight) { return sight.frame == tracks.anchors[k].frame; }));
  }
}

TEST(BackgroundTracker, PointsLiveOnFromAnchorToAnchor) {
  const Blobs blobs(5);
  BackgroundTracker tracker;
  constexpr double kSpeed = -6.3;
  for (int t = 0; t < 90; ++t) tracker.Push(blobs.Picture(280 + kSpeed * t, 0.4 * t), t / 30.0, {});
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_GE(tracks.anchors.size(), 3u);
  std::map<int, Eigen::Vector2f> at_birth;  // in the picture of frame 0
  for (size_t k = 0; k < tracks.anchors.size(); ++k) {
    const BackgroundTracks::Anchor& anchor = tracks.anchors[k];
    ASSERT_EQ(anchor.points.size(), anchor.pixels.size());
    EXPECT_EQ(std::set<int>(anchor.points.begin(), anchor.points.end()).size(), anchor.points.size());
    std::vector<double> off;
    for (size_t i = 0; i < anchor.points.size(); ++i) {
      const Eigen::Vector2f in_first = anchor.pixels[i] - float(anchor.frame) * Eigen::Vector2f(float(kSpeed), 0.4F);
      const auto [known, is_new] = at_birth.emplace(anchor.points[i], in_first);
      if (!is_new) off.push_back((known->second - in_first).norm());
    }
    if (k == 0) continue;
    EXPECT_GT(off.size(), 30u) << k;
    EXPECT_GT(anchor.points.size(), off.size() + 20) << "what comes into view has new names";
    EXPECT_LT(Percentile(off, 50), 0.2) << k;
    EXPECT_LT(Percentile(off, 90), 0.6) << k;
  }
}

TEST(BackgroundTracker, ACutBeginsAnew) {
  const Blobs before(6), after(7);
  BackgroundTracker tracker;
  for (int t = 0; t < 90; ++t) tracker.Push((t < 30 ? before : after).Picture(0, 0), t / 30.0, {});
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_EQ(tracks.anchors.size(), 2u);
  EXPECT_TRUE(tracks.anchors[1].after_break);
  EXPECT_GE(tracks.anchors[1].frame, 30);
  EXPECT_LE(tracks.anchors[1].frame, 56);
}

TEST(BackgroundTracker, AViewThatWasSeenBeforeIsFoundAgain) {
  const Blobs blobs(8);
  BackgroundTracker tracker;
  int t = 0;
  const auto push = [&](const Image& frame) { tracker.Push(frame, t / 30.0, {}), ++t; };
  for (; t < 45;) push(blobs.Picture(-7.0 * t, 0));
  for (int i = 0; i < 6; ++i) push(Image(kWidth, kHeight, {120, 120, 120}));
  const int returned = t;
  for (int i = 0; i < 6; ++i) push(blobs.Picture(2.0 * i, 0));
  const BackgroundTracks tracks = tracker.Finish();
  ASSERT_GE(tracks.anchors.size(), 3u);
  for (const BackgroundTracks::Anchor& anchor : tracks.anchors) EXPECT_EQ(anchor.after_break, anchor.frame == 0);
  const int again = tracks.anchors.back().frame;
  EXPECT_GE(again, returned);
  EXPECT_LT(again, returned + 5);
  const auto& sights = tracks.anchors.front().sights;
  const auto loop = std::find_if(sights.begin(), sights.end(), [&](const auto& s) { return s.frame == again; });
  ASSERT_NE(loop, sights.end());
  EXPECT_GT(NumSeen(*loop), int(0.5 * double(tracks.anchors.front().pixels.size())));
  const std::vector<int>&first = tracks.anchors.front().points, &last = tracks.anchors.back().points;
  EXPECT_GT(std::count_if(last.begin(), last.end(),
                          [&](int name) { return std::find(first.begin(), first.end(), name) != first.end(); }),
            int(first.size() / 4))
      << "its points live again";
}

TEST(BackgroundTracker, ABlankWallHasNoPoints) {
  BackgroundTracker tracker;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(120, 2);
  for (int t = 0; t < 20; ++t) {
    Image wall(kWidth, kHeight);
    for (uint8_t& level : wall.bgr) level = uint8_t(std::clamp(normal(random), 0.0, 255.0));
    tracker.Push(wall, t / 30.0, {});
  }
  for (const BackgroundTracks::Anchor& anchor : tracker.Finish().anchors) EXPECT_LT(anchor.pixels.size(), 12u);
}

TEST(BackgroundTracker, OddFramesAreRefused) {
  BackgroundTracker tracker;
  EXPECT_THROW(tracker.Push(Image(), 0, {}), std::invalid_argument);
  tracker.Push(Image(64, 48), 0, {});
  EXPECT_THROW(tracker.Push(Image(32, 48), 1, {}), std::invalid_argument);
  EXPECT_THROW(tracker.Push(Image(64, 48), 0, {}), std::invalid_argument);
  EXPECT_THROW(tracker.Push(Image(64, 48), std::numeric_limits<double>::quiet_NaN(), {}), std::invalid_argument);
  EXPECT_TRUE(BackgroundTracker().Finish().anchors.empty());
  BackgroundTracker tiny;
  for (int t = 0; t < 3; ++t) tiny.Push(Image(1, 1), t, {});
  EXPECT_EQ(tiny.Finish().timestamps.size(), 3u);
}

}  // namespace
}  // namespace bodyloom::background_tracker_test
