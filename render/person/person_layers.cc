// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/person_layers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// Colours, each times its weight, and the weights.
struct WeightedLevel {
  int width = 0, height = 0;
  std::vector<float> sums;  ///< 4 a cell: red, green, blue times weight; weight
};

WeightedLevel Half(const WeightedLevel& fine) {
  WeightedLevel coarse = {(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
  coarse.sums.assign(static_cast<size_t>(4) * coarse.width * coarse.height, 0);
  for (int y = 0; y < fine.height; ++y) {
    for (int x = 0; x < fine.width; ++x) {
      const float* from = &fine.sums[4 * (static_cast<size_t>(y) * fine.width + x)];
      float* to = &coarse.sums[4 * (static_cast<size_t>(y / 2) * coarse.width + x / 2)];
      for (int c = 0; c < 4; ++c) to[c] += from[c];
    }
  }
  return coarse;
}

/// Cells without weight take the colour of the cell above, as if it had been seen.
void FillFrom(const WeightedLevel& coarse, WeightedLevel* fine) {
  for (int y = 0; y < fine->height; ++y) {
    for (int x = 0; x < fine->width; ++x) {
      float* cell = &fine->sums[4 * (static_cast<size_t>(y) * fine->width + x)];
      const float* above = &coarse.sums[4 * (static_cast<size_t>(y / 2) * coarse.width + x / 2)];
      if (cell[3] > 0 || !(above[3] > 0)) continue;
      for (int c = 0; c < 3; ++c) cell[c] = above[c] / above[3];
      cell[3] = 1;
    }
  }
}

/// Whether there is one of `inside` up to `reach` entries away, along a line of `count` entries `stride` apart.
void ReachAlong(std::span<const uint8_t> inside, size_t first, size_t stride, int count, int reach,
                std::span<uint8_t> near) {
  int last = -reach - 1;
  const auto at = [&](int i) { return first + static_cast<size_t>(i) * stride; };
  for (int i = 0; i < count; ++i) {
    if (inside[at(i)] != 0) last = i;
    near[at(i)] = i - last <= reach ? 1 : 0;
  }
  last = count + reach;
  for (int i = count; i-- > 0;) {
    if (inside[at(i)] != 0) last = i;
    if (last - i <= reach) near[at(i)] = 1;
  }
}

/// Whether there is one of `inside` up to `reach` pixels away along x and y.
std::vector<uint8_t> Near(std::span<const uint8_t> inside, int width, int height, int reach) {
  std::vector<uint8_t> across(inside.size()), near(inside.size());
  const auto stride = static_cast<size_t>(width);
  for (int y = 0; y < height; ++y) ReachAlong(inside, y * stride, 1, width, reach, across);
  for (size_t x = 0; x < stride; ++x) ReachAlong(across, x, stride, height, reach, near);
  return near;
}

int RoundUp(int size) { return (size + kLayersMultiple - 1) / kLayersMultiple * kLayersMultiple; }

}  // namespace

PersonLayers BoxAround(int width, int height, std::span<const uint8_t> coverage, int reach) {
  int x0 = width, x1 = -1, y0 = height, y1 = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (coverage[static_cast<size_t>(y) * width + x] == 0) continue;
      x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
    }
  }
  PersonLayers layers;
  if (x1 < 0) return layers;
  const int across = x1 - x0 + 1, down = y1 - y0 + 1;
  layers.width = RoundUp(across + 2 * reach);
  layers.height = RoundUp(down + 2 * reach);
  layers.x = x0 - (layers.width - across) / 2, layers.y = y0 - (layers.height - down) / 2;
  return layers;
}

void FillAround(int width, int height, std::span<const float> alpha, std::span<float> colour) {
  const size_t pixels = alpha.size();
  BODYLOOM_CHECK(pixels == static_cast<size_t>(width) * height && colour.size() == 3 * pixels, "fill around: ", pixels,
                 " of alpha and ", colour.size(), " of colour for ", width, "x", height, " pixels");
  if (pixels == 0) return;
  std::vector<WeightedLevel> levels(1);
  levels[0] = {width, height, std::vector<float>(4 * pixels)};
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) levels[0].sums[4 * i + c] = alpha[i] > 0 ? alpha[i] * colour[c * pixels + i] : 0;
    levels[0].sums[4 * i + 3] = alpha[i] > 0 ? alpha[i] : 0;
  }
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(Half(levels.back()));
  for (size_t l = levels.size() - 1; l-- > 0;) FillFrom(levels[l + 1], &levels[l]);
  for (size_t i = 0; i < pixels; ++i) {
    if (alpha[i] > 0 || !(levels[0].sums[4 * i + 3] > 0)) continue;
    for (size_t c = 0; c < 3; ++c) colour[c * pixels + i] = levels[0].sums[4 * i + c];
  }
}

void KeepNearOutline(const PersonLayers& layers, std::span<float> change) {
  const size_t pixels = layers.pixels();
  BODYLOOM_CHECK(layers.planes.size() >= 4 * pixels && change.size() == 4 * pixels, "refiner: ", layers.planes.size(),
                 " numbers of layers and ", change.size(), " of change for ", pixels, " pixels");
  const std::span<const float> alpha = layers.Plane(PersonPlane::kAlpha);
  std::vector<uint8_t> drawn(pixels), bare(pixels);
  for (size_t i = 0; i < pixels; ++i) drawn[i] = alpha[i] > 0 ? 1 : 0, bare[i] = alpha[i] < 0.5F ? 1 : 0;
  const std::vector<uint8_t> near_drawn = Near(drawn, layers.width, layers.height, OutlineReach::kOutwards);
  const std::vector<uint8_t> near_bare = Near(bare, layers.width, layers.height, OutlineReach::kInwards);
  const std::span<float> of_alpha = change.subspan(PersonPlane::kAlpha * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    if ((of_alpha[i] > 0 ? near_drawn : near_bare)[i] == 0) of_alpha[i] = 0;
  }
}

std::vector<float> ChangedPerson(const PersonLayers& layers, std::span<const float> change) {
  const size_t pixels = layers.pixels();
  BODYLOOM_CHECK(layers.planes.size() >= 4 * pixels && change.size() == 4 * pixels, "refiner: ", layers.planes.size(),
                 " numbers of layers and ", change.size(), " of change for ", pixels, " pixels");
  std::vector<float> person(4 * pixels);
  // Colour and alpha are the first four planes, as those of the change.
  for (size_t i = 0; i < person.size(); ++i)
    person[i] = std::clamp(layers.planes[i] + std::tanh(change[i]), 0.0F, 1.0F);
  return person;
}

std::vector<float> EnlargedChange(const PersonLayers& small, std::span<const float> change, double factor,
                                  const PersonLayers& layers) {
  BODYLOOM_CHECK(change.size() == 4 * small.pixels() && factor > 0, "refiner: ", change.size(),
                 " numbers of change for ", small.pixels(), " pixels, to be enlarged by 1 / ", factor);
  struct Between {
    int low;      ///< row or column of the small box, which may lie outside
    float share;  ///< of the next one
  };
  const auto places = [factor](int first, int count, int small_first) {
    std::vector<Between> result(count);
    for (int i = 0; i < count; ++i) {
      const double at = factor * (first + i + 0.5) - 0.5 - small_first;
      result[i] = {static_cast<int>(std::floor(at)), static_cast<float>(at - std::floor(at))};
    }
    return result;
  };
  const std::vector<Between> columns = places(layers.x, layers.width, small.x);
  const std::vector<Between> rows = places(layers.y, layers.height, small.y);
  std::vector<float> enlarged(4 * layers.pixels(), 0);
  for (size_t c = 0; c < 4; ++c) {
    const float* from = change.data() + c * small.pixels();
    float* to = enlarged.data() + c * layers.pixels();
    const auto at = [&](int x, int y) {
      const bool inside = x >= 0 && y >= 0 && x < small.width && y < small.height;
      return inside ? from[static_cast<size_t>(y) * small.width + x] : 0.0F;
    };
    for (const Between& row : rows) {
      for (const Between& column : columns) {
        const float above = std::lerp(at(column.low, row.low), at(column.low + 1, row.low), column.share);
        const float below = std::lerp(at(column.low, row.low + 1), at(column.low + 1, row.low + 1), column.share);
        *to++ = std::lerp(above, below, row.share);
      }
    }
  }
  return enlarged;
}

void LayOver(const PersonLayers& layers, std::span<const float> person, Image* picture, std::span<uint8_t> coverage) {
  const size_t pixels = layers.pixels();
  BODYLOOM_CHECK(person.size() == 4 * pixels, "refiner: ", person.size(), " numbers for ", pixels, " pixels");
  BODYLOOM_CHECK(coverage.empty() || coverage.size() == static_cast<size_t>(picture->width) * picture->height,
                 "refiner: the coverage is of another size than the picture");
  ForEachPixel(layers, picture->width, picture->height, [&](int x, int y, size_t i) {
    const float alpha = person[3 * pixels + i];
    uint8_t* bgr = picture->pixel(x, y);
    for (size_t c = 0; c < 3; ++c) {
      const float under = (1 - alpha) * bgr[2 - c];
      bgr[2 - c] = static_cast<uint8_t>(std::clamp(under + 255 * alpha * person[c * pixels + i] + 0.5F, 0.0F, 255.0F));
    }
    if (coverage.empty()) return;
    coverage[static_cast<size_t>(y) * picture->width + x] = static_cast<uint8_t>(std::lround(255 * alpha));
  });
}

}  // namespace bodyloom
