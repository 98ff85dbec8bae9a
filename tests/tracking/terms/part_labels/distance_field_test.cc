// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace bodyloom::distance_field_test {
namespace {

using Eigen::Vector2d;
using Pixel = DistanceField::Pixel;

/// The definition, by brute force.
double BruteForce(int width, int height, const std::vector<Pixel>& image, int x, int y) {
  const double diagonal = std::hypot(width, height);
  double in = diagonal, out = diagonal;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      double& nearest = image[v * width + u] == Pixel::kInside ? in : out;
      if (image[v * width + u] != Pixel::kUnknown) nearest = std::min(nearest, std::hypot(u - x, v - y));
    }
  }
  const Pixel here = x < width && y < height ? image[y * width + x] : Pixel::kUnknown;
  return here == Pixel::kInside ? 0.5 - out : here == Pixel::kOutside ? in - 0.5 : in - out;
}

DistanceField MakeField(int width, int height, int cell, const std::vector<Pixel>& image, int x0 = 0, int y0 = 0) {
  return {x0,     y0,   width,
          height, cell, [&, y0, width](int y, Pixel* row) {
            std::copy_n(&image[size_t(y - y0) * width], width, row); }};
}

TEST(DistanceField, IsExactAtItsNodes) {
  std::mt19937 random(3);
  int checked = 0;
  for (const int cell : {1, 2, 5}) {
    for (const double share : {0.02, 0.5, 0.97}) {
      const int width = 31, height = 22;
      std::vector<Pixel> image(width * height);
      for (Pixel& p : image) {
        const double u = std::uniform_real_distribution<>()(random);
        p = u < share ? Pixel::kInside : u < share + 0.5 * (1 - share) ? Pixel::kOutside : Pixel::kUnknown;
      }
      const DistanceField field = MakeField(width, height, cell, image, -7, 100);
      for (int y = 0; y < height; y += cell) {
        for (int x = 0; x < width; x += cell) {
          EXPECT_NEAR(field.Evaluate(Vector2d(x - 7, y + 100)), BruteForce(width, height, image, x, y), 1e-5);
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 2500);
}

std::vector<Pixel> Disc(int width, int height, const Vector2d& centre, double radius) {
  std::vector<Pixel> image(width * height);
  for (int i = 0; i < width * height; ++i) {
    image[i] = (Vector2d(i % width, i / width) - centre).norm() < radius ? Pixel::kInside : Pixel::kOutside;
  }
  return image;
}

TEST(DistanceField, OfADiscIsItsSignedDistance) {
  const Vector2d centre(60.3, 50.8);
  const double radius = 25.2;
  for (const int cell : {1, 4}) {
    const DistanceField field = MakeField(121, 101, cell, Disc(121, 101, centre, radius));
    for (double angle = 0; angle < 6.28; angle += 0.1) {
      for (const double r : {12.0, 20.0, 25.2, 30.0, 45.0}) {
        const Vector2d direction(std::cos(angle), std::sin(angle));
        Eigen::RowVector2d gradient;
        const double distance = field.Evaluate(centre + r * direction, &gradient);
        EXPECT_NEAR(distance, r - radius, 0.8) << cell;
        if (cell == 1) continue;  // between neighbouring pixels the slope shows the mask's stairs
        EXPECT_NEAR(gradient.norm(), 1, 0.35);
        EXPECT_GT(gradient.dot(direction.transpose()), 0.7);
      }
    }
  }
}

TEST(DistanceField, GradientIsTheDerivativeOfWhatIsReturned) {
  std::mt19937 random(5);
  std::uniform_real_distribution<> u(-40, 160);
  const DistanceField field = MakeField(120, 100, 3, Disc(120, 100, {60.3, 50.8}, 25.2));
  int beyond = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector2d p{u(random), u(random)};
    beyond += p.x() < 0 || p.y() < 0 || p.x() > 119 || p.y() > 99;
    Eigen::RowVector2d gradient;
    field.Evaluate(p, &gradient);
    constexpr double kStep = 1e-5;
    for (int axis = 0; axis < 2; ++axis) {
      const Vector2d step = kStep * Vector2d::Unit(axis);
      EXPECT_NEAR(gradient[axis], (field.Evaluate(p + step) - field.Evaluate(p - step)) / (2 * kStep), 1e-5);
    }
  }
  EXPECT_GT(beyond, 100);
}

TEST(DistanceField, StaysFiniteWithoutABoundary) {
  for (const Pixel only : {Pixel::kInside, Pixel::kOutside, Pixel::kUnknown}) {
    const DistanceField field = MakeField(9, 7, 2, std::vector<Pixel>(63, only));
    EXPECT_LE(std::abs(field.Evaluate(Vector2d(4, 3))), std::hypot(9, 7));
    EXPECT_TRUE(std::isfinite(field.Evaluate(Vector2d(-1e6, 1e6))));
  }
  const DistanceField one = MakeField(1, 1, 1, {Pixel::kInside});
  EXPECT_TRUE(std::isfinite(one.Evaluate(Vector2d(0, 0))));
  EXPECT_THROW(MakeField(0, 4, 1, {}), std::invalid_argument);
}

TEST(DistanceField, BoundaryRunsThroughTheMiddleOfWhatIsUnknown) {
  // Columns 0–2 inside, 3–6 unknown, 7–11 outside: the boundary is at 4.5.
  std::vector<Pixel> image;
  image.reserve(12 * 5);
  for (int i = 0; i < 12 * 5; ++i) {
    image.push_back(i % 12 < 3 ? Pixel::kInside : i % 12 < 7 ? Pixel::kUnknown : Pixel::kOutside);
  }
  const DistanceField field = MakeField(12, 5, 1, image);
  EXPECT_NEAR(field.Evaluate(Vector2d(4.5, 2)), 0, 1e-6);
  EXPECT_NEAR(field.Evaluate(Vector2d(5, 2)), 1, 1e-6);
}

}  // namespace
}  // namespace bodyloom::distance_field_test
