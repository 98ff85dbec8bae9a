// SPDX-License-Identifier: Apache-2.0
/// Gaussians on the screen for tests of images and their derivatives.
#pragma once

#include "render/splat/project_gaussians.h"
#include "tests/support/splat_twin.h"

namespace bodyloom {

/// A pinhole whose image is 96×80.
inline Camera SplatCamera() {
  Camera camera = MakePinhole(96, 80, 150);
  camera.cx = 50.5, camera.cy = 37;
  return camera;
}

inline PixelBox WholeImage(const Camera& camera) { return {0, 0, camera.width, camera.height}; }

inline ScreenGaussians SeenCloud(int count, uint32_t seed, double spread = 0.5, double size = 0.06) {
  ScreenGaussians screen;
  ProjectGaussians(GaussianCloud(count, seed, spread, size), SplatCamera(), {}, &screen);
  return screen;
}

/// One Gaussian on the screen, round, with variance `variance_px2`.
struct ScreenSpot {
  float x, y, variance_px2, opacity, red, green, blue, depth;
};

inline ScreenGaussians ScreenOf(const std::vector<ScreenSpot>& spots) {
  using Out = ScreenGaussians;
  ScreenGaussians screen;
  screen.Resize(static_cast<int>(spots.size()));
  for (int i = 0; i < screen.size(); ++i) {
    const ScreenSpot& s = spots[i];
    const float half = std::sqrt(std::max(0.0F, 2 * std::log(255 * s.opacity) * s.variance_px2)) * 1.0001F + 0.01F;
    const float row[Out::kNumColumns] = {s.x,
                                         s.y,
                                         1 / s.variance_px2,
                                         0,
                                         1 / s.variance_px2,
                                         s.opacity,
                                         s.red,
                                         s.green,
                                         s.blue,
                                         s.depth,
                                         std::log2(s.opacity),
                                         half,
                                         half};
    for (int c = 0; c < Out::kNumColumns; ++c) screen.columns(i, c) = row[c];
  }
  return screen;
}

template <class T>
std::vector<TwinSplat<T>> TwinsOf(const ScreenGaussians& screen) {
  std::vector<TwinSplat<T>> twins;
  for (int i = 0; i < screen.size(); ++i) {
    if (!screen.IsDrawn(i)) continue;
    twins.push_back(TwinSplatOf(RowOf<T, ScreenGaussians::kNumGradients>(screen.columns, i),
                                screen.columns(i, ScreenGaussians::kDepth)));
  }
  return twins;
}

}  // namespace bodyloom
