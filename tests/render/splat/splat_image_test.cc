// SPDX-License-Identifier: Apache-2.0
// Images of Gaussians against closed forms and the reference implementation, and invariance of the bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "render/splat/splat_image.h"

#include "render/splat/splat_tiles.h"
#include "tests/render/splat/same_bytes.h"
#include "tests/render/splat/splat_scene.h"

namespace bodyloom::splat_image_test {
namespace {

using Plane = SplatImage::Plane;

float At(const SplatImage& image, Plane plane, int x, int y) {
  return image.plane(plane)[image.window().IndexOf(x, y)];
}

TEST(SplatImage, OneGaussianIsItsBell) {
  SplatImage image;
  image.Draw(ScreenOf({{20.25F, 30.5F, 9, 0.8F, 1, 0.5F, 0.25F, 2}}), {0, 0, 48, 64});
  int covered = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 48; ++x) {
      const double q = ((x - 20.25) * (x - 20.25) + (y - 30.5) * (y - 30.5)) / 9;
      double alpha = 0.8 * std::exp(-0.5 * q);
      if (alpha < 1.0 / 255) alpha = 0;
      EXPECT_NEAR(At(image, Plane::kAlpha, x, y), alpha, 1e-6) << x << ", " << y;
      EXPECT_NEAR(At(image, Plane::kRed, x, y), alpha, 1e-6);
      EXPECT_NEAR(At(image, Plane::kGreen, x, y), 0.5 * alpha, 1e-6);
      EXPECT_NEAR(At(image, Plane::kBlue, x, y), 0.25 * alpha, 1e-6);
      covered += static_cast<int>(alpha > 0);
    }
  }
  EXPECT_NEAR(covered, M_PI * 9 * 2 * std::log(255 * 0.8), 12);  // the ellipse's area
}

TEST(SplatImage, TheNearerIsOver) {
  for (const bool swapped : {false, true}) {
    std::vector<ScreenSpot> spots = {{8, 8, 4, 0.6F, 1, 0, 0, 2}, {8, 8, 4, 0.5F, 0, 1, 0, 3}};
    if (swapped) std::swap(spots[0], spots[1]);
    SplatImage image;
    image.Draw(ScreenOf(spots), {0, 0, 16, 16});
    EXPECT_NEAR(At(image, Plane::kRed, 8, 8), 0.6, 1e-6);
    EXPECT_NEAR(At(image, Plane::kGreen, 8, 8), 0.4 * 0.5, 1e-6);
    EXPECT_NEAR(At(image, Plane::kAlpha, 8, 8), 1 - 0.4 * 0.5, 1e-6);
  }
}

TEST(SplatImage, OfEqualDepthsTheFirstRowIsOver) {
  std::vector<ScreenSpot> spots(40, {8, 8, 4, 0.1F, 0, 0, 0, 2});
  for (int i = 0; i < 40; ++i) spots[i].red = static_cast<float>(i);
  SplatImage image;
  image.Draw(ScreenOf(spots), {0, 0, 16, 16}, {.stop_transmittance = 0});
  double expected = 0, passed = 1;
  for (int i = 0; i < 40; ++i, passed *= 0.9) expected += i * 0.1 * passed;
  EXPECT_NEAR(At(image, Plane::kRed, 8, 8), expected, 1e-5);
}

TEST(SplatImage, AlphaIsAtMost99Hundredths) {
  SplatImage image;
  image.Draw(ScreenOf({{8, 8, 4, 1, 1, 1, 1, 2}, {8, 8, 4, 1, 1, 0, 0, 3}}), {0, 0, 16, 16});
  EXPECT_NEAR(At(image, Plane::kAlpha, 8, 8), 1 - 0.01 * 0.01, 1e-6);
  EXPECT_NEAR(At(image, Plane::kGreen, 8, 8), 0.99, 1e-6);
}

TEST(SplatImage, AFinishedPixelTakesNoMore) {
  // T = 1, 0.1, 0.01, 0.001: the third is taken, the fourth is not.
  const std::vector<ScreenSpot> spots = {{8, 8, 4, 0.9F, 0, 0, 0, 1},
                                         {8, 8, 4, 0.9F, 0, 0, 0, 2},
                                         {8, 8, 4, 0.9F, 1, 0, 0, 3},
                                         {8, 8, 4, 0.9F, 0, 1, 0, 4}};
  SplatImage image;
  image.Draw(ScreenOf(spots), {0, 0, 16, 16}, {.stop_transmittance = 0.005F});
  EXPECT_NEAR(At(image, Plane::kRed, 8, 8), 0.9 * 0.01, 1e-6);
  EXPECT_EQ(At(image, Plane::kGreen, 8, 8), 0);
  EXPECT_NEAR(At(image, Plane::kAlpha, 8, 8), 0.999, 1e-6);
  image.Draw(ScreenOf(spots), {0, 0, 16, 16}, {.stop_transmittance = 0});
  EXPECT_NEAR(At(image, Plane::kGreen, 8, 8), 0.9 * 0.001, 1e-6);
}

TEST(SplatImage, IsItsTwin) {
  int compared = 0, marginal = 0;
  for (const uint32_t seed : {1U, 2U, 3U}) {
    for (const float stop : {0.0F, 1.0F / 512, 0.1F}) {
      const Camera camera = SplatCamera();
      const ScreenGaussians screen = SeenCloud(seed == 3 ? 900 : 120, seed, 0.5, seed == 2 ? 0.2 : 0.05);
      SplatImage image;
      image.Draw(screen, WholeImage(camera), {.stop_transmittance = stop});
      const auto twin = TwinDraw(TwinsOf<double>(screen), WholeImage(camera), stop);
      for (size_t i = 0; i < twin.marginal.size(); ++i) {
        marginal += static_cast<int>(twin.marginal[i]);
        if (twin.marginal[i]) continue;
        for (int p = 0; p < SplatImage::kNumPlanes; ++p) {
          ASSERT_NEAR(image.planes()(static_cast<int>(i), p), twin.planes[p][i], 4e-5) << i << ", " << p;
        }
        compared += static_cast<int>(twin.planes[3][i] > 0.1);
      }
    }
  }
  EXPECT_GT(compared, 30000);
  EXPECT_LT(marginal, 3000);
}

FloatColumns Drawn(const ScreenGaussians& screen, const PixelBox& window, int threads = 1) {
  SplatImage image;
  image.Draw(screen, window, {.num_threads = threads});
  FloatColumns copy(SplatImage::kNumPlanes, image.planes().rows());
  for (int p = 0; p < SplatImage::kNumPlanes; ++p) {
    std::copy_n(image.planes().column(p), copy.rows(), copy.column(p));
  }
  return copy;
}

TEST(SplatImage, SameBytesEverywhere) {
  const ScreenGaussians screen = SeenCloud(9000, 7, 0.6, 0.03);  // three chunks
  ExpectSameBytesEverywhere([&](int threads, FloatColumns* out) { *out = Drawn(screen, {-5, -7, 101, 90}, threads); });
}

TEST(SplatImage, AWindowIsACutOfTheWholeImage) {
  const ScreenGaussians screen = SeenCloud(2000, 9);
  const PixelBox whole{-40, -30, 130, 120};
  const FloatColumns all = Drawn(screen, whole);
  for (const PixelBox& window : {PixelBox{0, 0, 96, 80}, PixelBox{13, 27, 14, 28}, PixelBox{-33, 5, 47, 119},
                                 PixelBox{16, 16, 32, 32}, PixelBox{31, 17, 95, 34}}) {
    const FloatColumns part = Drawn(screen, window);
    for (int y = window.y_begin; y < window.y_end; ++y) {
      for (int x = window.x_begin; x < window.x_end; ++x) {
        for (int p = 0; p < SplatImage::kNumPlanes; ++p) {
          ASSERT_EQ(part(static_cast<int>(window.IndexOf(x, y)), p), all(static_cast<int>(whole.IndexOf(x, y)), p));
        }
      }
    }
  }
}

TEST(SplatImage, TheOrderOfRowsOfDifferentDepthsDoesNotMatter) {
  const ScreenGaussians screen = SeenCloud(1500, 4);
  ScreenGaussians shuffled;
  shuffled.Resize(screen.size());
  std::vector<int> rows(screen.size());
  std::iota(rows.begin(), rows.end(), 0);
  std::shuffle(rows.begin(), rows.end(), std::mt19937(1));
  for (int i = 0; i < screen.size(); ++i) {
    for (int c = 0; c < ScreenGaussians::kNumColumns; ++c) shuffled.columns(i, c) = screen.columns(rows[i], c);
  }
  EXPECT_TRUE(SameBytes(Drawn(screen, WholeImage(SplatCamera())), Drawn(shuffled, WholeImage(SplatCamera()))));
}

TEST(SplatImage, KeepsItsMemoryAndForgetsTheLastImage) {
  SplatImage image;
  const PixelBox window = WholeImage(SplatCamera());
  const ScreenGaussians many = SeenCloud(3000, 7), few = SeenCloud(50, 8);
  image.Draw(many, window);
  const float* memory = image.planes().data();
  image.Draw(few, window);
  EXPECT_EQ(image.planes().data(), memory);
  EXPECT_TRUE(SameBytes(image.planes(), Drawn(few, window)));
  image.Draw(few, {10, 10, 30, 50});
  EXPECT_EQ(image.planes().data(), memory);
  EXPECT_TRUE(SameBytes(image.planes(), Drawn(few, {10, 10, 30, 50})));
}

TEST(SplatImage, OfNothingAndOfNoPixel) {
  ScreenGaussians none;
  none.Resize(0);
  SplatImage image;
  image.Draw(none, {0, 0, 20, 20});
  for (int p = 0; p < SplatImage::kNumPlanes; ++p) {
    for (const float v : image.planes().values(p)) EXPECT_EQ(v, 0);
  }
  image.Draw(SeenCloud(100, 1), {5, 5, 5, 9});
  EXPECT_TRUE(image.window().empty());
  EXPECT_EQ(image.planes().rows(), 0);
  EXPECT_EQ(image.summary().drawn, 0);
}

TEST(SplatImage, APersonWhoLeavesTheImage) {
  // Half out, and wholly out: the window shows the part that is in it, then nothing.
  CameraGaussians cloud = GaussianCloud(400, 6);
  const Camera camera = SplatCamera();
  ScreenGaussians screen;
  double before = 1e9;
  for (const float shift : {0.0F, 0.6F, 1.2F, 30.0F}) {
    CameraGaussians moved = cloud;
    for (float& x : moved.columns.values(CameraGaussians::kX)) x += shift;
    ProjectGaussians(moved, camera, {}, &screen);
    SplatImage image;
    image.Draw(screen, WholeImage(camera));
    double covered = 0;
    for (const float alpha : image.plane(Plane::kAlpha)) covered += alpha;
    EXPECT_LT(covered, before);
    before = covered;
    if (shift > 10) {
      EXPECT_EQ(covered, 0);
    }
  }
}

TEST(SplatImage, OtherValuesOfTheSameImage) {
  const ScreenGaussians screen = SeenCloud(800, 3);
  const PixelBox window = WholeImage(SplatCamera());
  SplatImage image;
  image.Draw(screen, window);
  FloatColumns values(3, screen.size()), planes;
  for (int c = 0; c < 3; ++c) {
    std::copy_n(screen.columns.column(ScreenGaussians::kRed + (c + 1) % 3), screen.size(), values.column(c));
  }
  image.DrawValues(values, &planes);
  for (int i = 0; i < planes.rows(); ++i) {
    for (int c = 0; c < 3; ++c) ASSERT_EQ(planes(i, c), image.planes()(i, (c + 1) % 3));
  }
  values(7, 1) = NAN;
  EXPECT_THROW(image.DrawValues(values, &planes), std::invalid_argument);
  EXPECT_THROW(image.DrawValues(FloatColumns(3, 5), &planes), std::invalid_argument);
}

TEST(SplatImage, RefusesWhatItCannotDo) {
  SplatImage image;
  const ScreenGaussians screen = SeenCloud(10, 1);
  EXPECT_THROW(image.Draw(screen, {0, 0, 9, 9}, {.stop_transmittance = NAN}), std::invalid_argument);
  EXPECT_THROW(image.Draw(screen, {0, 0, 9, 9}, {.num_threads = 0}), std::invalid_argument);
  EXPECT_THROW(image.Draw(screen, {0, 0, 1 << 21, 1}), std::invalid_argument);
  EXPECT_THROW(image.Draw(screen, {0, 0, 1 << 15, 1 << 15}), std::invalid_argument);
}

/// Floats of every kind: ordinary, huge, tiny, denormal, zeros of both signs, infinities, NaN, raw bits.
float Garbage(std::mt19937* generator) {
  const auto bits = static_cast<uint32_t>((*generator)());
  switch ((*generator)() % 8) {
    case 0:
      return std::bit_cast<float>(bits);
    case 1:
      return INFINITY * (bits % 2 == 0 ? 1.0F : -1.0F);
    case 2:
      return std::numeric_limits<float>::quiet_NaN();
    case 3:
      return std::bit_cast<float>(bits % (1U << 23));
    case 4:
      return bits % 2 == 0 ? 0.0F : -0.0F;
    default:
      return std::ldexp(static_cast<float>(bits) / 4294967296.0F - 0.5F, static_cast<int>(bits % 24) - 12);
  }
}

TEST(SplatImage, GarbageNeitherCrashesNorShows) {
  std::mt19937 generator(17);
  SplatImage image;
  ScreenGaussians screen;
  int drawn = 0;
  for (int round = 0; round < 120; ++round) {
    CameraGaussians cloud = GaussianCloud(200, round);
    const unsigned spoilt = 1 + round % 16;
    for (int i = 0; i < cloud.size(); ++i) {
      for (unsigned k = 0; k < generator() % (spoilt + 1); ++k) {
        cloud.columns(i, static_cast<int>(generator() % CameraGaussians::kNumColumns)) = Garbage(&generator);
      }
    }
    const float low_pass = round % 3 == 0 ? 0.0F : 0.2F;
    ProjectGaussians(cloud, SplatCamera(), {.low_pass_px2 = low_pass}, &screen);
    image.Draw(screen, {-3, -3, 70, 60}, {.stop_transmittance = round % 2 == 0 ? 0.0F : 0.01F});
    drawn += image.summary().drawn;
    for (int p = 0; p < SplatImage::kNumPlanes; ++p) {
      for (const float v : image.planes().values(p)) ASSERT_TRUE(std::isfinite(v)) << "round " << round;
    }
    for (const float alpha : image.plane(Plane::kAlpha)) ASSERT_TRUE(alpha >= 0 && alpha <= 1) << "round " << round;
  }
  EXPECT_GT(drawn, 2000);
}

std::vector<int32_t> Expected(const std::vector<float>& depth, std::vector<int32_t> rows) {
  std::stable_sort(rows.begin(), rows.end(), [&](int a, int b) { return depth[a] < depth[b]; });
  return rows;
}

void ExpectSorted(const std::vector<float>& depth, const std::vector<int32_t>& rows) {
  DepthOrder order;
  const auto sorted = order.Sort(depth, rows);
  EXPECT_EQ(std::vector<int32_t>(sorted.begin(), sorted.end()), Expected(depth, rows));
}

std::vector<int32_t> AllRows(size_t count) {
  std::vector<int32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(DepthOrder, IsThatOfAStableSort) {
  std::mt19937 generator(3);
  for (const float scale : {1e-6F, 1.0F, 1e30F}) {
    for (const int steps : {3, 50, 1 << 20}) {  // few steps: many equal depths
      std::vector<float> depth(5000);
      const int below_zero = steps / 3;
      for (float& d : depth) d = scale * static_cast<float>(static_cast<int>(generator() % steps) - below_zero);
      for (float& d : depth) d = d == 0 ? 0.0F : d;
      ExpectSorted(depth, AllRows(depth.size()));
    }
  }
}

TEST(DepthOrder, OfSomeRowsInAnyOrder) {
  std::vector<float> depth = {5, 1, 4, 1, 3, 1};
  ExpectSorted(depth, {5, 0, 3, 4, 1});
}

TEST(DepthOrder, NeighbouringFloatsAndInfinities) {
  std::vector<float> depth = {INFINITY, 1, std::nextafter(1.0F, 2.0F), std::nextafter(1.0F, 0.0F), -INFINITY, 1};
  ExpectSorted(depth, AllRows(depth.size()));
}

TEST(DepthOrder, OfNothingAndOfOne) {
  ExpectSorted({}, {});
  ExpectSorted({2}, {0});
}

}  // namespace

}  // namespace bodyloom::splat_image_test
