// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/line_segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace bodyloom::line_segments_test {
namespace {

using Eigen::Vector2d;

/// Grey with light bars: each an upright rectangle whose two long edges are segments.
Image Room(int width, int height, const std::vector<int>& columns) {
  Image image(width, height, {90, 90, 90});
  for (const int x0 : columns) {
    for (int y = height / 4; y < 3 * height / 4; ++y) {
      for (int x = x0; x < x0 + width / 20; ++x) std::fill_n(image.pixel(x, y), 3, uint8_t{200});
    }
  }
  return image;
}

/// Somebody in stripes, whose edges are lines as well.
void AddPerson(int x0, int y0, int size, Image* image) {
  for (int y = y0; y < y0 + size; ++y) {
    for (int x = x0; x < x0 + size; ++x) std::fill_n(image->pixel(x, y), 3, uint8_t((x - x0) / 12 % 2 == 0 ? 20 : 240));
  }
}

std::vector<LineSegment> Find(const std::vector<Image>& frames, const std::vector<CoveredPixels>& covered = {}) {
  FrameSamples samples;
  for (const Image& frame : frames) samples.Add(frame);
  return FindLineSegments(MedianPicture(samples, covered));
}

/// Segments with both ends in the rectangle.
int NumInside(const std::vector<LineSegment>& segments, double x0, double y0, double x1, double y1) {
  return int(std::count_if(segments.begin(), segments.end(), [&](const LineSegment& s) {
    const auto inside = [&](const Vector2d& p) { return p.x() >= x0 && p.x() <= x1 && p.y() >= y0 && p.y() <= y1; };
    return inside(s.a) && inside(s.b);
  }));
}

/// An upright segment at x from y0 to y1, within `tolerance` pixels.
bool HasUpright(const std::vector<LineSegment>& segments, double x, double y0, double y1, double tolerance) {
  return std::any_of(segments.begin(), segments.end(), [&](const LineSegment& s) {
    return std::abs(s.a.x() - x) < tolerance && std::abs(s.b.x() - x) < tolerance &&
           std::abs(std::min(s.a.y(), s.b.y()) - y0) < 3 * tolerance &&
           std::abs(std::max(s.a.y(), s.b.y()) - y1) < 3 * tolerance;
  });
}

TEST(LineSegments, AreWhereTheyWereDrawn) {
  const std::vector<LineSegment> segments = Find({Room(640, 480, {100, 400})});
  for (const double x : {99.5, 131.5, 399.5, 431.5}) EXPECT_TRUE(HasUpright(segments, x, 119.5, 359.5, 1.5)) << x;
}

TEST(LineSegments, OfAShrunkPictureAreInFullPixels) {
  const std::vector<LineSegment> segments = Find({Room(2560, 1920, {400, 1600})});
  for (const double x : {399.5, 527.5, 1599.5, 1727.5}) EXPECT_TRUE(HasUpright(segments, x, 479.5, 1439.5, 4)) << x;
}

TEST(LineSegments, ShortOnesAreLeftOut) {
  Image image(640, 480, {90, 90, 90});
  AddPerson(300, 200, 11, &image);  // 11 pixels of 640: below 2 %
  EXPECT_TRUE(Find({image}).empty());
}

TEST(LineSegments, OfAMaskedPersonAreNotUsed) {
  Image image = Room(640, 480, {100});
  AddPerson(350, 120, 200, &image);
  ASSERT_GT(NumInside(Find({image}), 340, 110, 560, 330), 5) << "the stripes are lines";
  FrameSamples samples;
  samples.Add(image);
  CoveredPixels covered;
  const LabelImage mask{350, 120, 200, 200, std::vector<uint8_t>(200 * 200, 1)};
  CoverMask(mask, samples.small(), &covered);
  const std::vector<LineSegment> masked = FindLineSegments(MedianPicture(samples, std::vector<CoveredPixels>{covered}));
  EXPECT_EQ(NumInside(masked, 340, 110, 560, 330), 0);
  EXPECT_TRUE(HasUpright(masked, 99.5, 119.5, 359.5, 1.5)) << "the room's are still there";
}

TEST(LineSegments, OfAPersonWhoWalksAreNotInTheMedian) {
  std::vector<Image> frames;
  std::vector<CoveredPixels> covered;
  for (int t = 0; t < 10; ++t) {
    frames.push_back(Room(640, 480, {100, 400}));
    AddPerson(20 + 45 * t, 150, 150, &frames.back());
    FrameSamples sample;
    sample.Add(frames.back());
    CoverBox(20 + 45 * t, 150, 170 + 45 * t, 300, sample.small(), &covered.emplace_back());
  }
  const std::vector<LineSegment> segments = Find(frames, covered);
  for (const double x : {99.5, 131.5, 399.5, 431.5}) EXPECT_TRUE(HasUpright(segments, x, 119.5, 359.5, 1.5)) << x;
  EXPECT_EQ(segments.size(), Find({Room(640, 480, {100, 400})}).size()) << "nothing else";
}

TEST(LineSegments, BordersAndBlackBarsAreLeftOut) {
  Image image(640, 480, {0, 0, 0});
  const Image inner(400, 480, {120, 120, 120});
  Paste(inner, 120, 0, &image);
  EXPECT_TRUE(Find({image}).empty());
}

TEST(MedianPicture, KnowsACameraThatMoves) {
  std::mt19937 random(1);
  Image wall(640, 480);
  for (uint8_t& value : wall.bgr) value = uint8_t(random() % 256);
  FrameSamples still, moving;
  for (int t = 0; t < 10; ++t) {
    still.Add(wall);
    Image moved = wall;
    std::rotate(moved.bgr.begin(), moved.bgr.begin() + 3 * 5 * t, moved.bgr.end());
    moving.Add(moved);
  }
  EXPECT_EQ(MedianPicture(still, {}).restless_share, 0);
  EXPECT_GT(MedianPicture(moving, {}).restless_share, 0.8);
}

TEST(MedianPicture, MasksWhatPeopleAlwaysCover) {
  FrameSamples samples;
  std::vector<CoveredPixels> covered(10);
  for (int t = 0; t < 10; ++t) {
    samples.Add(Image(100, 50, {uint8_t(10 * t), uint8_t(10 * t), uint8_t(10 * t)}));
    CoverBox(-0.5, -0.5, 9.5, 49.5, samples.small(), &covered[t]);               // always
    if (t > 1) CoverBox(9.5, -0.5, 19.5, 49.5, samples.small(), &covered[t]);    // seen twice: a fifth
    if (t != 4) CoverBox(19.5, -0.5, 29.5, 49.5, samples.small(), &covered[t]);  // seen once
  }
  const StillPicture picture = MedianPicture(samples, covered, 2);
  EXPECT_EQ(picture.people[5], 1);
  EXPECT_EQ(picture.people[15], 0);
  EXPECT_EQ(picture.grey[15], 10) << "the larger of 0 and 10";
  EXPECT_EQ(picture.people[25], 1);
  EXPECT_EQ(picture.people[35], 0);
  EXPECT_EQ(picture.grey[35], 50);
}

TEST(FrameSamples, AreSpreadOverAClipOfAnyLength) {
  for (const int length : {1, 12, 24, 25, 100, 1000}) {
    FrameSamples samples;
    for (int t = 0; t < length; ++t) samples.Add(Image(8, 8, {uint8_t(t), uint8_t(t), uint8_t(t)}));
    const std::vector<GreySample>& kept = samples.samples();
    EXPECT_GE(kept.size(), size_t(std::min(length, FrameSamples::kFewestSamples))) << length;
    EXPECT_LE(kept.size(), size_t(2 * FrameSamples::kFewestSamples)) << length;
    EXPECT_EQ(kept.front().frame, 0);
    EXPECT_GE(kept.back().frame + length / FrameSamples::kFewestSamples, length - 1) << length;
    for (size_t i = 2; i < kept.size(); ++i) {
      EXPECT_EQ(kept[i].frame - kept[i - 1].frame, kept[1].frame - kept[0].frame) << length;
    }
    for (const GreySample& sample : kept) EXPECT_EQ(sample.grey[0], uint8_t(sample.frame)) << length;
  }
}

TEST(FrameSamples, WrongSizesAreRefused) {
  FrameSamples samples;
  EXPECT_THROW(samples.Add(Image()), std::invalid_argument);
  samples.Add(Image(20, 10));
  EXPECT_THROW(samples.Add(Image(10, 20)), std::invalid_argument);
  EXPECT_THROW(MedianPicture(samples, std::vector<CoveredPixels>(2)), std::invalid_argument);
  EXPECT_THROW(MedianPicture(samples, std::vector<CoveredPixels>{CoveredPixels(7)}), std::invalid_argument);
  CoveredPixels covered;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CoverBox(nan, 0, 5, 5, samples.small(), &covered);
  CoverBox(-1e12, -1e12, -1e11, 1e12, samples.small(), &covered);
  EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 0);
  EXPECT_TRUE(FindLineSegments(MedianPicture(FrameSamples(), {})).empty());
}

}  // namespace
}  // namespace bodyloom::line_segments_test
