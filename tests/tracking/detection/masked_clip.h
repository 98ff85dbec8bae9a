// SPDX-License-Identifier: Apache-2.0
/// A small clip with known truth: a textured wall, and a person of two colours who walks past it.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct MaskedClip {
  static constexpr int kWidth = 160, kHeight = 120;
  Image wall;
  std::vector<Image> images;
  std::vector<std::vector<uint8_t>> masks;  ///< the truth

  /// `shift`: motion of the wall, pixels per frame; `gain`: of the light in the second half.
  explicit MaskedClip(int num_frames, int shift = 0, double gain = 1) : wall(kWidth, kHeight) {
    std::mt19937 random(5);
    const auto noise = [&](int up_to) { return static_cast<int>(random() % (2 * up_to + 1)) - up_to; };
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) Paint(wall, x, y, WallAt(x, y));
    }
    for (int t = 0; t < num_frames; ++t) {
      Image& frame = images.emplace_back(wall);
      std::vector<uint8_t>& mask = masks.emplace_back(size_t(kWidth) * kHeight, 0);
      const double light = 2 * t < num_frames ? 1 : gain;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const bool is_person = IsPerson(t, num_frames, x, y);
          mask[size_t(y) * kWidth + x] = is_person ? 1 : 0;
          Colour colour = is_person ? PersonAt(y) : WallAt(x + shift * t, y);
          for (uint8_t* c : {&colour.red, &colour.green, &colour.blue}) {
            *c = static_cast<uint8_t>(std::min(255.0, std::max(0.0, light * *c + noise(2))));
          }
          Paint(frame, x, y, colour);
        }
      }
    }
  }

  /// The true mask without the feet, with a piece of the wall added, and with its edge off by 3 px.
  [[nodiscard]] std::vector<uint8_t> CoarseMask(int t) const {
    std::vector<uint8_t> coarse(masks[t].size(), 0);
    const int middle = MiddleAt(t, static_cast<int>(masks.size()));
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool wider = std::abs(x - middle) <= kHalfWidth + 3 && y >= kTop && y < kBottom - 4;
        const bool wall_beside = x > middle && x <= middle + kHalfWidth + 10 && y >= 50 && y < 65;
        coarse[size_t(y) * kWidth + x] = wider || wall_beside ? 1 : 0;
      }
    }
    return coarse;
  }

 private:
  static constexpr int kHalfWidth = 12, kTop = 15, kBottom = 110;

  static int MiddleAt(int t, int num_frames) { return 30 + 100 * t / std::max(1, num_frames - 1); }
  static bool IsPerson(int t, int num_frames, int x, int y) {
    return std::abs(x - MiddleAt(t, num_frames)) <= kHalfWidth && y >= kTop && y < kBottom;
  }
  static Colour PersonAt(int y) { return y < 60 ? Colour{170, 60, 50} : Colour{20, 22, 30}; }
  static Colour WallAt(int x, int y) {
    const double wave = 25 * std::sin(0.4 * x) + 20 * std::cos(0.31 * y + 0.1 * x);
    return {uint8_t(130 + wave), uint8_t(150 + 0.8 * wave), uint8_t(120 - 0.5 * wave)};
  }
  static void Paint(Image& image, int x, int y, Colour colour) {
    uint8_t* bgr = image.pixel(x, y);
    bgr[0] = colour.blue, bgr[1] = colour.green, bgr[2] = colour.red;
  }
};

/// Intersection over union.
template <class A, class B>
double OverlapOf(const A& a, const B& b) {
  double both = 0, either = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    both += a[i] != 0 && b[i] != 0;
    either += a[i] != 0 || b[i] != 0;
  }
  return either > 0 ? both / either : 1;
}

}  // namespace bodyloom
