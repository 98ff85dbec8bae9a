// SPDX-License-Identifier: Apache-2.0
// Compositing of a rendered person over a background, at the networks' size and enlarged.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "pipelines/animate/background.h"
#include "tests/support/test_files.h"

namespace bodyloom::background_test {
namespace {

PersonWindow WindowAt(int width, int height, const Eigen::Vector2i& corner, int image_width, int image_height) {
  PersonWindow window;
  window.width = width, window.height = height;
  window.image_width = image_width, window.image_height = image_height;
  window.corner = {corner};
  return window;
}

/// A person of random colours and coverage: planar RGB, multiplied by alpha.
struct Person {
  std::vector<float> image, alpha;
  Person(int width, int height) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(0, 1);
    const size_t area = static_cast<size_t>(width) * height;
    alpha.resize(area);
    image.resize(3 * area);
    for (float& a : alpha) a = uniform(random);
    for (size_t i = 0; i < image.size(); ++i) image[i] = uniform(random) * alpha[i % area];
  }
};

TEST(Composite, AtTheNetworksSizeEveryPixelIsImagePlusWhatAlphaLeavesOfTheImage) {
  const Person person(5, 4);
  for (const auto& corner :
       {Eigen::Vector2i(2, 3), Eigen::Vector2i(-2, -1), Eigen::Vector2i(9, 6), Eigen::Vector2i(50, 50)}) {
    Image image(12, 9, {10, 90, 200});
    Composite(person.image, person.alpha, WindowAt(5, 4, corner, 12, 9), 0, &image);
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 12; ++x) {
        const int u = x - corner.x(), v = y - corner.y();
        const bool inside = u >= 0 && u < 5 && v >= 0 && v < 4;
        const float a = inside ? person.alpha[v * 5 + u] : 0;
        const auto expected = [&](int c, float behind) {
          return std::lround((inside ? 255 * person.image[20 * c + v * 5 + u] : 0) + (1 - a) * behind);
        };
        const Colour colour = image.at(x, y);
        ASSERT_EQ(colour.red, expected(0, 10)) << x << ", " << y;
        ASSERT_EQ(colour.green, expected(1, 90)) << x << ", " << y;
        ASSERT_EQ(colour.blue, expected(2, 200)) << x << ", " << y;
      }
    }
  }
}

/// Bilinear interpolation keeps a ramp: three times as large, its values lie on the same line.
TEST(Composite, EnlargedARampStaysOneAndLiesWhereItLay) {
  constexpr int kSide = 8, kTimes = 3;
  std::vector<float> alpha(kSide * kSide, 1), image;
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < kSide * kSide; ++i) image.push_back(static_cast<float>(i % kSide + 4) / 16);
  }
  Image canvas(10 * kTimes, 10 * kTimes, {0, 255, 0});
  Composite(image, alpha, WindowAt(kSide, kSide, {1, 1}, 10, 10), 0, &canvas);
  for (int y = kTimes * 2; y < kTimes * 8; ++y) {
    for (int x = kTimes * 2; x < kTimes * 8; ++x) {
      const double column = (x + 0.5) / kTimes - 0.5 - 1;
      ASSERT_NEAR(canvas.at(x, y).red, 255 * (column + 4) / 16, 0.51) << x << ", " << y;
    }
  }
  EXPECT_EQ(canvas.at(0, 0), (Colour{0, 255, 0}));
  EXPECT_EQ(canvas.at(29, 15), (Colour{0, 255, 0}));
}

TEST(Composite, ImagesAreAsLargeAsTheNetworksDrawOrAsTheCamera) {
  const PersonWindow window = WindowAt(64, 96, {0, 0}, 108, 72);
  const Camera camera = MakePinhole(1920, 1280, 1500);
  const ImageSize small = SizeOfImages(window, camera, false), large = SizeOfImages(window, camera, true);
  EXPECT_EQ(small.width, 108);
  EXPECT_EQ(small.height, 72);
  EXPECT_EQ(large.width, 1920);
  EXPECT_EQ(large.height, 1280);
}

TEST(Background, AnotherShapeIsCutAndNotStretched) {
  Image wide(40, 10, {1, 1, 1});
  for (int y = 0; y < 10; ++y) {
    for (int x = 15; x < 25; ++x) wide.pixel(x, y)[2] = 201;  // a red square in the middle
  }
  const Image square = Covering(wide, 10, 10), larger = Covering(wide, 20, 20);
  EXPECT_EQ(square, Image(10, 10, {201, 1, 1}));
  EXPECT_EQ(larger.width, 20);
  EXPECT_EQ(larger.at(10, 10), (Colour{201, 1, 1}));
  EXPECT_EQ(Covering(wide, 40, 10), wide);
  const Image tall = Covering(wide, 10, 40);
  EXPECT_EQ(tall.height, 40);
  EXPECT_EQ(tall.at(5, 20), (Colour{201, 1, 1}));
}

/// A window of 3 × 2 pixels at (1, 1) of a picture of 6 × 4, and what networks predicted for it.
struct Drawn {
  PersonWindow window;
  MotionImage rendered;
  Drawn() {
    window.width = 3, window.height = 2, window.image_width = 6, window.image_height = 4;
    window.corner = {{1, 1}};
    rendered.width = 3, rendered.height = 2;
    rendered.labels = {1, 2, 3, 0, 5, 6};
    rendered.alpha.assign(6, 1);
    rendered.image.assign(18, 0.5F);
    rendered.normals.assign(18, 0);
    for (int i = 0; i < 6; ++i) {
      const float angle = 0.2F * static_cast<float>(i);
      rendered.normals[i] = 0.8F * std::sin(angle);  // shortened, as uncertain foreground is
      rendered.normals[12 + i] = -0.8F * std::cos(angle);
    }
  }
};

// A rendered clip written as a single-person dataset.

TEST(RenderedDataset, AtTheNetworksSizeClassesStayAndNormalsBecomeUnitVectors) {
  const Drawn drawn;
  const PersonFrame frame = SetFrameOf(drawn.rendered, drawn.window, 0, Image(6, 4, {7, 8, 9}));
  EXPECT_EQ(frame.rgb, Image(6, 4, {7, 8, 9}));
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      const bool inside = x >= 1 && x < 4 && y >= 1 && y < 3;
      const int i = 3 * (y - 1) + x - 1, label = inside ? drawn.rendered.labels[i] : 0;
      EXPECT_EQ(frame.labels.at(x, y), (Colour{uint8_t(label), uint8_t(label), uint8_t(label)})) << x << ", " << y;
      const Colour normal = frame.normals.at(x, y);
      if (label == 0) {
        EXPECT_EQ(normal, (Colour{0, 0, 0})) << x << ", " << y;
        continue;
      }
      EXPECT_NEAR(NormalOfCode(normal.red), std::sin(0.2 * i), 1.01 / 255) << x << ", " << y;
      EXPECT_NEAR(NormalOfCode(normal.green), 0, 1.01 / 255);
      EXPECT_NEAR(NormalOfCode(normal.blue), -std::cos(0.2 * i), 1.01 / 255);
    }
  }
}

TEST(RenderedDataset, EnlargedEveryPixelTakesTheNearestClass) {
  const Drawn drawn;
  const PersonFrame frame = SetFrameOf(drawn.rendered, drawn.window, 0, Image(18, 12));
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 18; ++x) {
      const bool inside = x >= 3 && x < 12 && y >= 3 && y < 9;
      const int label = inside ? drawn.rendered.labels[3 * (y / 3 - 1) + x / 3 - 1] : 0;
      EXPECT_EQ(frame.labels.at(x, y).red, label) << x << ", " << y;
      if (label == 0) continue;
      const Colour normal = frame.normals.at(x, y);
      const double length = std::hypot(NormalOfCode(normal.red), NormalOfCode(normal.green), NormalOfCode(normal.blue));
      EXPECT_NEAR(length, 1, 0.01);
    }
  }
}

TEST(RenderedDataset, IsASinglePersonDatasetOnlyWhenFinished) {
  SynthClipOptions options;
  options.camera.width = 24, options.camera.height = 16;
  options.dense_per_frame = 0;
  options.keypoints = false;
  const Track track = MakeSynthClip(BuiltinBody(), DemoMotion(BuiltinBody(), 2, 25), options).truth;
  Drawn drawn;
  drawn.window.corner = {{1, 1}, {0, 0}};
  const std::string folder = EmptyFolder("rendered_dataset");
  RenderedDataset set(folder, track, 25, true, true, "animate");
  set.Add(0, drawn.rendered, drawn.window, Image(24, 16, {1, 2, 3}));
  EXPECT_THROW(SinglePersonDataset{folder}, std::runtime_error);
  set.Add(1, {}, drawn.window, Image(24, 16));  // no fit
  set.Finish();
  const SinglePersonDataset read(folder);
  EXPECT_EQ(read.info().num_frames, 2);
  EXPECT_NEAR(read.info().fps, 25, 1e-6);
  EXPECT_EQ(read.track().num_frames(), 2);
  EXPECT_EQ(read.Read(0).labels.at(6, 6).red, 1);
  EXPECT_EQ(read.Read(1).labels, Image(24, 16)) << "a frame without a fit is background";

  drawn.rendered.labels.clear();
  drawn.rendered.normals.clear();
  RenderedDataset bare(EmptyFolder("rendered_dataset_bare"), track, 25, false, false, "animate");
  for (const int t : {0, 1}) bare.Add(t, drawn.rendered, drawn.window, Image(24, 16));
  EXPECT_NO_THROW(bare.Finish());
}

}  // namespace

}  // namespace bodyloom::background_test
