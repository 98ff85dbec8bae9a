// SPDX-License-Identifier: Apache-2.0
#include "render/garment/clothes_offset_map.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "geometry/base/check.h"
#include "render/texture/complete/body_part_map.h"

namespace bodyloom {
namespace {

constexpr int kTorsoLimb = 1;

/// The body pixel nearest to each pixel (Chebyshev distance), −1 without a body.
std::vector<int> NearestOfBody(const PhotoFrame& photo) {
  const int size = photo.size;
  std::vector<int> nearest(photo.parts.size(), -1);
  for (size_t i = 0; i < nearest.size(); ++i) {
    if (photo.parts[i] != 0) nearest[i] = static_cast<int>(i);
  }
  const auto distance = [&](size_t from, int to) {
    const int at = static_cast<int>(from);
    return to < 0 ? 2 * size : std::max(std::abs(at % size - to % size), std::abs(at / size - to / size));
  };
  SweepNeighbours(size, size, /*rows_back=*/true, [&](size_t here, size_t there) {
    if (distance(here, nearest[there]) < distance(here, nearest[here])) nearest[here] = nearest[there];
  });
  return nearest;
}

/// Scale of the offsets in this frame, pixels.
double BodyScale(const PhotoFrame& photo) {
  const auto diagonal = [&](bool torso) {
    int left = photo.size, top = photo.size, right = -1, bottom = -1;
    for (int y = 0; y < photo.size; ++y) {
      for (int x = 0; x < photo.size; ++x) {
        const uint8_t part = photo.parts[size_t(y) * photo.size + x];
        if (part == 0 || (torso && LimbOf(part) != kTorsoLimb)) continue;
        left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
      }
    }
    return right < 0 ? 0.0 : std::hypot(right - left + 1, bottom - top + 1);
  };
  const double torso = diagonal(true);
  return torso > 0 ? torso : std::max(1.0, diagonal(false) / 3);
}

}  // namespace

std::vector<float> ClothesOffsetMap(const PhotoFrame& photo, const TexelNeighbours& neighbours) {
  const int size = photo.size, U = neighbours.texture_size();
  const size_t pixels = size_t(size) * size, texels = size_t(U) * U;
  BODYLOOM_CHECK(photo.parts.size() == pixels && photo.labels.size() == pixels && photo.uv.size() == 2 * pixels,
                 "clothes' offset: a frame of ", size, " px with ", photo.parts.size(), " parts, ", photo.labels.size(),
                 " labels and ", photo.uv.size(), " coordinates");
  const std::vector<int> nearest = NearestOfBody(photo);
  std::vector<int> reach(pixels, -1);  // of the rim's pixels; −1 elsewhere
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const size_t i = size_t(y) * size + x;
      const int q = nearest[i];
      if (photo.parts[i] != 0 || q < 0) continue;
      const int distance = std::max(std::abs(x - q % size), std::abs(y - q / size));
      if (photo.labels[i] != 0 || distance == 1) reach[q] = std::max(reach[q], photo.labels[i] != 0 ? distance : 0);
    }
  }
  const double scale = BodyScale(photo);
  std::vector<float> clothes_offset(texels);
  std::vector<double> sum(texels);
  std::vector<int> count(texels);
  for (size_t q = 0; q < pixels; ++q) {
    if (reach[q] < 0) continue;
    const int column = std::clamp(static_cast<int>(photo.uv[q] * static_cast<float>(U)), 0, U - 1);
    const int row = std::clamp(static_cast<int>((1 - photo.uv[pixels + q]) * static_cast<float>(U)), 0, U - 1);
    sum[size_t(row) * U + column] += reach[q] / scale;
    ++count[size_t(row) * U + column];
  }
  std::vector<uint8_t> shown(texels);
  for (size_t t = 0; t < texels; ++t) {
    if (count[t] == 0) continue;
    shown[t] = 1;
    clothes_offset[t] = static_cast<float>(sum[t] / count[t]);
  }
  neighbours.FillUnseen(shown, 1, clothes_offset);
  return clothes_offset;
}

std::vector<float> ClothedBody(const PhotoFrame& pose, std::span<const float> clothes_offset) {
  const int size = pose.size;
  const size_t pixels = size_t(size) * size;
  BODYLOOM_CHECK(pose.parts.size() == pixels && clothes_offset.size() == pixels, "clothed body: a frame of ", size,
                 " px with ", pose.parts.size(), " parts and ", clothes_offset.size(), " offsets");
  const auto scale = static_cast<float>(BodyScale(pose));
  const auto far = static_cast<float>(-2 * size);
  std::vector<float> left(pixels, far);  // remaining offset at a pixel
  for (size_t i = 0; i < pixels; ++i) {
    if (pose.parts[i] != 0) left[i] = scale * clothes_offset[i];
  }
  SweepNeighbours(size, size, /*rows_back=*/false,
                  [&](size_t here, size_t there) { left[here] = std::max(left[here], left[there] - 1); });
  for (size_t i = 0; i < pixels; ++i) left[i] = pose.parts[i] != 0 ? 1.0F : std::clamp(0.5F + left[i], 0.0F, 1.0F);
  return left;
}

}  // namespace bodyloom
