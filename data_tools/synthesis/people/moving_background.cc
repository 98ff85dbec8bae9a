// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/synthesis/people/moving_background.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bodyloom/data_tools/synthesis/people/wardrobe.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using Eigen::Vector3f;

/// 0 1 2 … n−1 n−1 … 1 0 0 1 …
int Mirrored(int i, int n) {
  const int m = ((i % (2 * n)) + 2 * n) % (2 * n);
  return m < n ? m : 2 * n - 1 - m;
}

struct Shape {
  float x, y, rx, ry;  ///< in heights of the picture
  bool is_box;
  Vector3f colour;
};

}  // namespace

MovingBackground::MovingBackground(int width, int height, uint64_t seed)
    : width_(width), height_(height), picture_(2 * width, height + height / 4) {
  BODYLOOM_CHECK(width > 0 && height > 0, "background: ", width, "x", height, " pixels");
  HashRandom random(seed, {0x6261636b});
  const auto colour = [&](double low, double high) {
    Vector3f c;
    for (float& x : c) x = float(random.Uniform(low, high));
    return c;
  };
  const Vector3f above = colour(110, 220), below = colour(60, 170), stain = colour(-45, 45);
  std::vector<Shape> shapes(6 + random.Below(5));
  for (Shape& s : shapes) {
    s = {float(random.Uniform(0, 1.6)),    float(random.Uniform(0, 1)), float(random.Uniform(0.04, 0.25)),
         float(random.Uniform(0.04, 0.3)), random.Uniform() < 0.5,      colour(40, 230)};
  }
  const uint64_t noise = random.Next();
  for (int y = 0; y < picture_.height; ++y) {
    for (int x = 0; x < picture_.width; ++x) {
      const float u = float(x) / float(height), v = float(y) / float(height);
      Vector3f c = above + std::min(v, 1.0F) * (below - above);
      for (const Shape& s : shapes) {
        const float dx = std::abs(u - s.x) / s.rx, dy = std::abs(v - s.y) / s.ry;
        if (s.is_box ? std::max(dx, dy) < 1 : dx * dx + dy * dy < 1) c += 0.55F * (s.colour - c);
      }
      c += (ValueNoise({6 * u, 6 * v, 0}, noise) - 0.5F) * stain +
           Vector3f::Constant(18 * (ValueNoise({40 * u, 40 * v, 0}, noise + 1) - 0.5F));
      for (int k = 0; k < 3; ++k) picture_.pixel(x, y)[2 - k] = uint8_t(std::clamp(c[k], 0.0F, 255.0F));
    }
  }
  const double speed = random.Uniform(0.02, 0.06) * height, angle = random.Uniform(0, 2 * M_PI);
  velocity_px_s_ = {speed * std::cos(angle), 0.3 * speed * std::sin(angle)};
}

Image MovingBackground::At(double time_s) const {
  Image view(width_, height_);
  const Eigen::Vector2d shift = velocity_px_s_ * time_s;
  const int x0 = static_cast<int>(std::floor(shift.x())), y0 = static_cast<int>(std::floor(shift.y()));
  const int fx = static_cast<int>(256 * (shift.x() - x0)), fy = static_cast<int>(256 * (shift.y() - y0));
  std::vector<int> column(width_ + 1);
  for (int x = 0; x <= width_; ++x) column[x] = 3 * Mirrored(x + x0, picture_.width);
  for (int y = 0; y < height_; ++y) {
    const uint8_t* const upper = picture_.pixel(0, Mirrored(y + y0, picture_.height));
    const uint8_t* const lower = picture_.pixel(0, Mirrored(y + y0 + 1, picture_.height));
    uint8_t* to = view.pixel(0, y);
    for (int x = 0; x < width_; ++x) {
      for (int k = 0; k < 3; ++k) {
        const int a = column[x] + k, b = column[x + 1] + k;
        const int up = (256 - fx) * upper[a] + fx * upper[b], low = (256 - fx) * lower[a] + fx * lower[b];
        *to++ = static_cast<uint8_t>(((256 - fy) * up + fy * low + 32768) >> 16);
      }
    }
  }
  return view;
}

}  // namespace bodyloom
