// SPDX-License-Identifier: Apache-2.0
/// Reference implementation of render/splat in its simplest form, for double or for automatic derivatives (ceres::Jet):
/// matrices as loops, every Gaussian against every pixel, sorted by std::stable_sort, no tiles, no boxes.
#pragma once

#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/image/pixel_box.h"
#include "render/splat/camera_gaussians.h"

namespace bodyloom {

inline double RealPart(double x) { return x; }
template <int N>
double RealPart(const ceres::Jet<double, N>& x) {
  return x.a;
}

/// One row of CameraGaussians.
template <class T>
struct TwinGaussian {
  std::array<T, 3> position;
  std::array<T, 9> factor;
  T opacity;
  std::array<T, 3> colour;
};

/// One row of ScreenGaussians.
template <class T>
struct TwinSplat {
  std::array<T, 2> mean;
  std::array<T, 3> conic;
  T opacity;
  std::array<T, 3> colour;
  double depth;
};

template <class T>
TwinSplat<T> TwinProject(const TwinGaussian<T>& g, const Camera& camera, double low_pass) {
  T jacobian[2][3] = {{T(0), T(0), T(0)}, {T(0), T(0), T(0)}};
  TwinSplat<T> splat;
  const auto& [x, y, z] = g.position;
  if (camera.model == CameraModel::kPinhole) {
    splat.mean = {T(camera.fx) * x / z + T(camera.cx), T(camera.fy) * y / z + T(camera.cy)};
    jacobian[0][0] = T(camera.fx) / z, jacobian[0][2] = -T(camera.fx) * x / (z * z);
    jacobian[1][1] = T(camera.fy) / z, jacobian[1][2] = -T(camera.fy) * y / (z * z);
  } else {
    splat.mean = {T(camera.scale) * (x + T(camera.tx)) + T(camera.cx),
                  T(camera.scale) * (y + T(camera.ty)) + T(camera.cy)};
    jacobian[0][0] = jacobian[1][1] = T(camera.scale);
  }
  T covariance[3][3], seen[2][2];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      covariance[i][j] = T(0);
      for (int k = 0; k < 3; ++k) covariance[i][j] += g.factor[3 * i + k] * g.factor[3 * j + k];
    }
  }
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      seen[i][j] = T(i == j ? low_pass : 0);
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) seen[i][j] += jacobian[i][k] * covariance[k][l] * jacobian[j][l];
      }
    }
  }
  const T det = seen[0][0] * seen[1][1] - seen[0][1] * seen[1][0];
  splat.conic = {seen[1][1] / det, -seen[0][1] / det, seen[0][0] / det};
  splat.opacity = g.opacity;
  splat.colour = g.colour;
  splat.depth = RealPart(z);
  return splat;
}

template <class T>
struct TwinSplatImage {
  std::array<std::vector<T>, 4> planes;  ///< premultiplied red, green, blue; alpha
  std::vector<bool> marginal;            ///< pixels where a cut-off or early stop was within `margin` of its threshold
};

template <class T>
TwinSplatImage<T> TwinDraw(const std::vector<TwinSplat<T>>& splats, const PixelBox& box, double stop,
                           double margin = 1e-4) {
  using std::exp;
  std::vector<int> order(splats.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return splats[a].depth < splats[b].depth; });
  TwinSplatImage<T> image;
  image.marginal.assign(box.area(), false);
  for (auto& plane : image.planes) plane.assign(box.area(), T(0));
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const size_t at = box.IndexOf(x, y);
      T transmittance(1);
      for (const int i : order) {
        const TwinSplat<T>& s = splats[i];
        const T dx = T(x) - s.mean[0], dy = T(y) - s.mean[1];
        const T q = s.conic[0] * dx * dx + T(2) * s.conic[1] * dx * dy + s.conic[2] * dy * dy;
        T alpha = s.opacity * exp(T(-0.5) * q);
        const double cut = RealPart(alpha) * 255, passed = RealPart(transmittance);
        if (std::abs(cut - 1) < margin || std::abs(passed / stop - 1) < margin ||
            std::abs(RealPart(alpha) - 0.99) < 0.01 * margin) {
          image.marginal[at] = true;
        }
        if (cut < 1 || passed < stop) continue;
        if (RealPart(alpha) > 0.99) alpha = T(0.99);
        for (int c = 0; c < 3; ++c) image.planes[c][at] += s.colour[c] * alpha * transmittance;
        transmittance *= T(1) - alpha;
      }
      image.planes[3][at] = T(1) - transmittance;
    }
  }
  return image;
}

/// The first kNumGradients columns of a row.
template <class T>
TwinSplat<T> TwinSplatOf(const std::array<T, ScreenGaussians::kNumGradients>& row, double depth) {
  return {{row[0], row[1]}, {row[2], row[3], row[4]}, row[5], {row[6], row[7], row[8]}, depth};
}

template <class T>
TwinGaussian<T> TwinGaussianOf(const std::array<T, CameraGaussians::kNumColumns>& row) {
  TwinGaussian<T> g;
  std::copy_n(row.begin(), 3, g.position.begin());
  std::copy_n(row.begin() + CameraGaussians::kFactor, 9, g.factor.begin());
  g.opacity = row[CameraGaussians::kOpacity];
  std::copy_n(row.begin() + CameraGaussians::kRed, 3, g.colour.begin());
  return g;
}

/// Row i of a table.
template <class T, size_t kColumns>
std::array<T, kColumns> RowOf(const FloatColumns& columns, int i) {
  std::array<T, kColumns> row;
  for (size_t c = 0; c < kColumns; ++c) row[c] = T(columns(i, static_cast<int>(c)));
  return row;
}

/// Gaussians of all shapes around the centre of a camera's view, some rotated, some flat, some occluded; `size` is
/// their maximum standard deviation in metres.
inline CameraGaussians GaussianCloud(int count, uint32_t seed, double spread = 0.5, double size = 0.06) {
  std::mt19937 generator(seed);
  const auto uniform = [&] { return generator() / 4294967296.0; };
  CameraGaussians cloud;
  cloud.Resize(count);
  for (int i = 0; i < count; ++i) {
    FloatColumns& c = cloud.columns;
    c(i, CameraGaussians::kX) = static_cast<float>(spread * (2 * uniform() - 1));
    c(i, CameraGaussians::kY) = static_cast<float>(spread * (2 * uniform() - 1));
    c(i, CameraGaussians::kZ) = static_cast<float>(2 + uniform());
    const double largest = size * (0.2 + 0.8 * uniform());
    for (int k = 0; k < 9; ++k) {
      c(i, CameraGaussians::kFactor + k) = static_cast<float>(largest * (2 * uniform() - 1));
    }
    if (i % 5 == 1) {  // flat: the third axis is all but zero
      for (int r = 0; r < 3; ++r) c(i, CameraGaussians::kFactor + 3 * r + 2) *= 0.01F;
    }
    c(i, CameraGaussians::kOpacity) = static_cast<float>(i % 7 == 3 ? 1 : 0.05 + 0.9 * uniform());
    for (int k = 0; k < 3; ++k) c(i, CameraGaussians::kRed + k) = static_cast<float>(1.5 * uniform() - 0.2);
  }
  return cloud;
}

}  // namespace bodyloom
