// SPDX-License-Identifier: Apache-2.0
#include "render/view/person_window.h"

#include <gtest/gtest.h>

namespace bodyloom::person_window_test {
namespace {

PersonExtent Box(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y1}}; }

TEST(PersonWindow, HoldsEveryFrameAndMovesOnlyWhenItMust) {
  const std::vector<PersonExtent> extents = {
      Box(100, 50, 160, 190), Box(102, 50, 162, 190), {}, Box(150, 60, 210, 195)};
  const PersonWindow window = PlanPersonWindow(extents, 400, 300, {.max_side = 256, .multiple = 16, .margin = 0.1});
  EXPECT_EQ(window.scale_x, 1);
  EXPECT_EQ(window.width % 16, 0);
  EXPECT_EQ(window.height % 16, 0);
  // 60 + 1 + 2 · 14 = 89 wide, 140 + 1 + 28 = 169 high.
  EXPECT_EQ(window.width, 96);
  EXPECT_EQ(window.height, 176);
  for (const size_t t : {0U, 1U, 3U}) {
    const double margin = 0.1 * (extents[t].max - extents[t].min).maxCoeff();
    for (int c = 0; c < 2; ++c) {
      EXPECT_LE(window.corner[t][c], extents[t].min[c] - margin) << t;
      EXPECT_GE(window.corner[t][c] + (c == 0 ? window.width : window.height), extents[t].max[c] + 1 + margin) << t;
    }
  }
  EXPECT_EQ(window.corner[0], window.corner[1]);  // 2 px fit into what rounding up to 16 left
  EXPECT_EQ(window.corner[2], window.corner[1]);
  EXPECT_GT(window.corner[3].x(), window.corner[1].x());
}

TEST(PersonWindow, ShrinksTallPeopleAndNeverEnlarges) {
  const PersonWindow small = PlanPersonWindow({Box(10, 10, 30, 60)}, 100, 100, {});
  EXPECT_EQ(small.scale_x, 1);
  const PersonWindow large = PlanPersonWindow({Box(300, 100, 900, 1100)}, 1920, 1200, {.max_side = 256});
  EXPECT_LE(large.height, 256);
  EXPECT_GT(large.height, 240);
  EXPECT_NEAR(large.scale_x, 256.0 / (1000 * 1.25), 0.01);  // the margin above ends at the picture's border
}

TEST(PersonWindow, CameraAndImageAgree) {
  Image image(320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      image.pixel(x, y)[0] = static_cast<uint8_t>(x / 2);
      image.pixel(x, y)[1] = static_cast<uint8_t>(y);
    }
  }
  const PersonWindow window =
      PlanPersonWindow({Box(100, 30, 200, 210)}, 320, 240, {.max_side = 96, .multiple = 16, .margin = 0.05});
  const Image cut = CutWindow(image, window, 0);
  const std::vector<uint8_t> labels = CutLabels(image, window, 0);
  const Camera camera = MakePinhole(320, 240, 300), inside = CameraInWindow(camera, window, 0);
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(-0.3, 0.4, 2.5)}) {
    Eigen::Vector2d original, cropped;
    ASSERT_TRUE(camera.Project(point, &original));
    ASSERT_TRUE(inside.Project(point, &cropped));
    const int x = static_cast<int>(std::lround(cropped.x())), y = static_cast<int>(std::lround(cropped.y()));
    EXPECT_NEAR(cut.pixel(x, y)[0], original.x() / 2, 1.5);
    EXPECT_NEAR(cut.pixel(x, y)[1], original.y(), 2.5);
    EXPECT_NEAR(labels[size_t(y) * window.width + x], original.x() / 2, 1.5);
  }
}

TEST(PersonWindow, BlackOutsideTheImage) {
  Image image(64, 64, {255, 255, 255});
  PersonWindow window = PlanPersonWindow({Box(0, 0, 20, 60)}, 64, 64, {.multiple = 16, .margin = 0});
  window.corner[0] = {-5, -3};
  const Image cut = CutWindow(image, window, 0);
  EXPECT_EQ(cut.at(4, 10), Colour());
  EXPECT_EQ(cut.at(5, 10), (Colour{255, 255, 255}));
  EXPECT_EQ(CutLabels(image, window, 0)[2 * window.width + 20], 0);
  EXPECT_EQ(CutLabels(image, window, 0)[3 * window.width + 20], 255);
}

TEST(PersonWindow, RefusesWhatMakesNoSense) {
  EXPECT_THROW(PlanPersonWindow({{}, {}}, 100, 100), std::invalid_argument);
  EXPECT_THROW(PlanPersonWindow({Box(0, 0, 5, 5)}, 0, 100), std::invalid_argument);
  EXPECT_THROW(PlanPersonWindow({Box(0, 0, 5, 5)}, 100, 100, {.max_side = 8, .multiple = 16}), std::invalid_argument);
  const PersonWindow window = PlanPersonWindow({Box(0, 0, 5, 5)}, 100, 100);
  EXPECT_THROW(CutWindow(Image(90, 100), window, 0), std::invalid_argument);
  EXPECT_THROW(CutWindow(Image(100, 100), window, 1), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::person_window_test
