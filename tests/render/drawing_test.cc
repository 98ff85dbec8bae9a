// SPDX-License-Identifier: Apache-2.0
// Images, captions, contact sheets, landmarks and floors: content and positions of the drawings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/image/image.h"
#include "render/image/palette.h"
#include "render/image/pixel_box.h"
#include "render/view/caption.h"
#include "render/view/contact_sheet.h"
#include "render/view/floor.h"
#include "render/view/overlay_landmarks.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::drawing_test {
namespace {

constexpr Colour kWhite{255, 255, 255};

/// Pixels of `image` that differ from `before`, as a box and a count.
struct Difference {
  PixelBox box{1 << 20, 1 << 20, 0, 0};
  int count = 0;
};
Difference DifferenceOf(const Image& image, const Image& before) {
  Difference d;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y) == before.at(x, y)) continue;
      d.box = {std::min(d.box.x_begin, x), std::min(d.box.y_begin, y), std::max(d.box.x_end, x + 1),
               std::max(d.box.y_end, y + 1)};
      ++d.count;
    }
  }
  return d;
}

TEST(Image, HoldsItsPixels) {
  Image image(7, 5, {10, 20, 30});
  EXPECT_EQ(image.bgr.size(), 3u * 7 * 5);
  EXPECT_EQ(image.at(6, 4), (Colour{10, 20, 30}));
  EXPECT_EQ(image.pixel(0, 0)[0], 30);  // blue first
  EXPECT_TRUE(Image().empty());
  EXPECT_THROW(Image(-1, 3), std::invalid_argument);
}

TEST(Image, PastesWithClipping) {
  const Image patch(4, 4, {200, 0, 0});
  Image image(8, 6, kWhite);
  const Image before = image;
  Paste(patch, 6, -2, &image);
  const Difference d = DifferenceOf(image, before);
  EXPECT_EQ(d.count, 2 * 2);
  EXPECT_EQ(d.box.x_begin, 6);
  EXPECT_EQ(d.box.y_end, 2);
  Paste(patch, 100, 100, &image);
  Paste(patch, -100, 0, &image);
  EXPECT_EQ(DifferenceOf(image, before).count, 4);
}

TEST(Image, ResizeKeepsTheMean) {
  Image image(40, 30);
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 30; ++y) image.pixel(x, y)[1] = static_cast<uint8_t>(5 * x + y);
  }
  const auto mean = [](const Image& i) { return std::accumulate(i.bgr.begin(), i.bgr.end(), 0.0) / i.bgr.size(); };
  const Image small = Resized(image, 10, 10);
  EXPECT_EQ(small.width, 10);
  EXPECT_NEAR(mean(small), mean(image), 0.5);
  EXPECT_NEAR(mean(Resized(image, 120, 90)), mean(image), 1.0);
  EXPECT_THROW(Resized(Image(), 3, 3), std::invalid_argument);
}

TEST(Caption, StandsInItsCorner) {
  const Image before(320, 240, kWhite);
  const struct {
    Corner corner;
    bool right, bottom;
  } cases[] = {{Corner::kTopLeft, false, false},
               {Corner::kTopRight, true, false},
               {Corner::kBottomLeft, false, true},
               {Corner::kBottomRight, true, true}};
  for (const auto& c : cases) {
    Image image = before;
    DrawCaption({{"frame 12"}, {"error 1.8 px", CaptionLine::Mark::kDisc, {255, 0, 0}}}, c.corner, 10, &image);
    const Difference d = DifferenceOf(image, before);
    EXPECT_GT(d.count, 1000);
    EXPECT_EQ(d.box.x_begin > 160, c.right);
    EXPECT_EQ(d.box.y_begin > 120, c.bottom);
    EXPECT_EQ(d.box.x_end < 160, !c.right);
    EXPECT_EQ(d.box.y_end < 120, !c.bottom);
  }
}

TEST(Caption, ShrinksLongLinesAndLeavesTinyImagesAlone) {
  const Image before(160, 120, kWhite);
  Image image = before;
  DrawCaption({{.text = std::string(200, 'W')}}, Corner::kTopLeft, 12, &image);
  EXPECT_LE(DifferenceOf(image, before).box.x_end, 160);
  EXPECT_GT(DifferenceOf(image, before).count, 0);
  Image tiny(6, 6, kWhite);
  DrawCaption({{"text"}}, Corner::kBottomRight, 20, &tiny);
  EXPECT_EQ(tiny, Image(6, 6, kWhite));
  DrawCaption({}, Corner::kTopLeft, 12, &image);
  DrawCaption({{"caf\xc3\xa9"}}, Corner::kTopLeft, 12, &image);  // not ASCII: drawn, not thrown
}

TEST(ContactSheet, PutsImagesInRows) {
  std::vector<Image> images;
  images.reserve(5);
  for (int i = 0; i < 5; ++i) images.emplace_back(40, 20, Colour{static_cast<uint8_t>(50 * i), 100, 0});
  const Image sheet = ContactSheet(images, {.columns = 2, .cell_height_px = 20, .gap_px = 4});
  EXPECT_EQ(sheet.width, 2 * 44 + 4);
  EXPECT_EQ(sheet.height, 3 * 24 + 4);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(sheet.at(4 + 44 * (i % 2) + 20, 4 + 24 * (i / 2) + 10).red, 50 * i) << "picture " << i;
  }
  EXPECT_EQ(sheet.at(1, 1), ContactSheetOptions().background);
  EXPECT_THROW(ContactSheet({}), std::invalid_argument);
  EXPECT_THROW(ContactSheet({Image()}), std::invalid_argument);
}

TEST(ContactSheet, SpreadsFramesEvenly) {
  EXPECT_EQ(EvenlySpreadFrames(100, 3), (std::vector<int>{0, 50, 99}));
  EXPECT_EQ(EvenlySpreadFrames(2, 5), (std::vector<int>{0, 1}));
  EXPECT_EQ(EvenlySpreadFrames(9, 1), (std::vector<int>{4}));
  EXPECT_TRUE(EvenlySpreadFrames(0, 4).empty());
}

TEST(DrawKeypoints, DrawsWhatIsThereAndNothingElse) {
  const Image before(100, 100, kWhite);
  DrawnKeypoints points;
  points.names = {"left_elbow", "left_wrist", "right_elbow", "nose"};
  points.pixels.resize(4, 2);
  points.pixels << 20, 20, 60, 20, 50, 80, std::nan(""), 4;
  points.confidence = {0.9F, 0.8F, 0.05F, 1.0F};
  points.min_confidence = 0.1;
  Image image = before;
  DrawKeypoints(points, {.size_px = 4}, &image);
  EXPECT_NE(image.at(20, 20), kWhite);
  EXPECT_NE(image.at(40, 20), kWhite) << "the bone between elbow and wrist";
  EXPECT_EQ(image.at(50, 80), kWhite) << "too weak";
  EXPECT_EQ(image.at(20, 20), kLeftColour);
  image = before;
  DrawKeypoints(points, {.size_px = 6, .bones = false, .hollow = true}, &image);
  EXPECT_EQ(image.at(20, 20), kWhite) << "rings are hollow";
  EXPECT_NE(image.at(26, 20), kWhite);
  image = before;
  DrawKeypoints(points, {.size_px = 4, .alpha = 0.5}, &image);
  const int halfway = (255 + kLeftColour.blue) / 2;
  EXPECT_NEAR(image.at(20, 20).blue, halfway, 2);
  points.pixels.row(0) << 1e30, -1e30;  // far outside: left out instead of overflowing
  EXPECT_NO_THROW(DrawKeypoints(points, {}, &image));
  points.names.pop_back();
  EXPECT_THROW(DrawKeypoints(points, {}, &image), std::invalid_argument);
}

TEST(DrawKeypoints, ResidualsJoinTwins) {
  DrawnKeypoints a, b;
  a.names = b.names = {"nose"};
  a.pixels.resize(1, 2);
  b.pixels.resize(1, 2);
  a.pixels << 10, 50;
  b.pixels << 90, 50;
  Image image(100, 100);
  DrawResiduals(a, b, 2, &image);
  EXPECT_GT(image.at(50, 50).red, 200);
  EXPECT_EQ(image.at(50, 60).red, 0);
  b.names = {"left_eye"};
  EXPECT_THROW(DrawResiduals(a, b, 2, &image), std::invalid_argument);
}

TEST(Floor, GridIsBelowTheHorizonAndShadowUnderTheBody) {
  const Camera camera = MakePinhole(200, 200, 200);
  const Floor floor{Eigen::Vector3d(0, 1, 0), -Eigen::Vector3d::UnitY()};
  const Image before(200, 200, kWhite);
  Image image = before;
  DrawFloorGrid(floor, Eigen::Vector3d(0, 1, 4), {}, camera, &image);
  const Difference grid = DifferenceOf(image, before);
  EXPECT_GT(grid.count, 200);
  EXPECT_GT(grid.box.y_begin, 100) << "the horizon";
  // Lines run at whole multiples of the spacing: x = 0.5 m, z = 4 m is seen at 99.5 + 200·0.5/4, 99.5 + 200/4.
  EXPECT_NE(image.at(125, 150), kWhite);
  image = before;
  const MatrixX3d vertices =
      PoseVertices(ToyBody(), Eigen::VectorXd(),
                   PoseFromAxisAngle(ToyBody(), RandomAxisAngle(ToyBody(), 0, 0), Eigen::Vector3d(0, 0.25, 4)));
  const double lowest = vertices.col(1).maxCoeff();
  DrawShadow(vertices, ToyBody().data().faces, {Eigen::Vector3d(0, lowest, 0), -Eigen::Vector3d::UnitY()}, camera, 0.5,
             &image);
  const Difference shadow = DifferenceOf(image, before);
  EXPECT_GT(shadow.count, 100);
  EXPECT_GT(shadow.box.y_begin, 110);
  EXPECT_GE(image.at(100, 150).red, 127);
}

TEST(Palette, SidesAreToldApart) {
  for (int part = 3; part <= 24; part += 2) EXPECT_NE(PartColour(part), PartColour(part + 1)) << part;
  EXPECT_EQ(PartColour(-1), PartColour(0));
  EXPECT_EQ(PartColour(25), PartColour(0));
}

}  // namespace
}  // namespace bodyloom::drawing_test
