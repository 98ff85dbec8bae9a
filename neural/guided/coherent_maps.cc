// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/coherent_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/check.h"
#include "render/garment/clothes_offset_map.h"

namespace bodyloom {
namespace {

/// The four grid points around (x, y), clamped to the grid, with bilinear weights, nearest first.
struct Around {
  std::array<size_t, 4> index;
  std::array<float, 4> weight;
};

Around AroundPoint(float x, float y, int size) {
  const float last = static_cast<float>(size - 1);
  x = std::clamp(x, 0.0F, last);
  y = std::clamp(y, 0.0F, last);
  const int x0 = std::min(static_cast<int>(x), size - 1), y0 = std::min(static_cast<int>(y), size - 1);
  const int x1 = std::min(x0 + 1, size - 1), y1 = std::min(y0 + 1, size - 1);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto at = [&](int column, int row) { return size_t(row) * size + column; };
  Around around{{at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)},
                {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
  const auto nearest =
      static_cast<size_t>(std::max_element(around.weight.begin(), around.weight.end()) - around.weight.begin());
  std::swap(around.index[0], around.index[nearest]);
  std::swap(around.weight[0], around.weight[nearest]);
  return around;
}

}  // namespace

CoherentMaps EmptyMaps(int size, std::span<const uint8_t> texel_parts) {
  const size_t area = size_t(size) * size;
  BODYLOOM_CHECK(size > 0 && texel_parts.size() == area, "coherent maps: ", texel_parts.size(), " parts of ", size, "x",
                 size, " texels");
  return {size,
          std::vector<float>(3 * area),
          std::vector<uint8_t>(area),
          std::vector<uint8_t>(area),
          {texel_parts.begin(), texel_parts.end()},
          {}};
}

int FillEmptyTexels(const PhotoFrame& frame, const RenderedPerson& rendered, uint8_t from,
                    std::span<const uint8_t> no_face, CoherentMaps* maps) {
  const size_t texels = maps->from.size(), pixels = size_t(frame.size) * frame.size;
  BODYLOOM_CHECK(from > 0 && frame.texture_size == maps->size && frame.texel_cosine.size() == texels &&
                     frame.texel_pixels.size() == 2 * texels && rendered.size == frame.size &&
                     rendered.image.size() == 3 * pixels && rendered.alpha.size() == pixels &&
                     rendered.labels.size() == pixels && (no_face.empty() || no_face.size() == texels),
                 "coherent maps: a frame of ", frame.texture_size, " texels and ", frame.size, " px beside maps of ",
                 maps->size, " and an image of ", rendered.size);
  int filled = 0;
  for (size_t i = 0; i < texels; ++i) {
    if (maps->from[i] != 0 || maps->texel_parts[i] == 0 || frame.texel_cosine[i] == 0) continue;
    const Around around = AroundPoint(frame.texel_pixels[i], frame.texel_pixels[texels + i], frame.size);
    const uint8_t label = rendered.labels[around.index[0]];
    if (label == 0 || (label == kFaceLabel && !no_face.empty() && no_face[i] != 0)) continue;
    float weight = 0;
    std::array<float, 3> colour{};
    for (size_t k = 0; k < 4; ++k) {
      const size_t pixel = around.index[k];
      if (rendered.labels[pixel] == 0) continue;
      weight += around.weight[k] * rendered.alpha[pixel];
      for (size_t c = 0; c < 3; ++c) colour[c] += around.weight[k] * rendered.image[c * pixels + pixel];
    }
    if (!(weight > 0)) continue;
    for (size_t c = 0; c < 3; ++c) maps->appearance[c * texels + i] = std::clamp(colour[c] / weight, 0.0F, 1.0F);
    maps->labels[i] = label;
    maps->from[i] = from;
    ++filled;
  }
  return filled;
}

RenderedPerson OwnImage(const PhotoFrame& frame) {
  const size_t pixels = size_t(frame.size) * frame.size;
  BODYLOOM_CHECK(frame.image.size() == 3 * pixels && frame.labels.size() == pixels, "coherent maps: a frame of ",
                 frame.size, " px has an image of ", frame.image.size(), " and ", frame.labels.size(), " labels");
  RenderedPerson rendered{frame.size, frame.image, std::vector<float>(pixels), frame.labels};
  for (size_t i = 0; i < pixels; ++i) rendered.alpha[i] = frame.labels[i] != 0 ? 1.0F : 0.0F;
  return rendered;
}

CoherentMaps MapsOf(std::span<const PhotoFrame> photos, std::span<const uint8_t> texel_parts) {
  CoherentMaps maps = EmptyMaps(photos.front().texture_size, texel_parts);
  for (size_t k = 0; k < photos.size(); ++k) {
    FillEmptyTexels(photos[k], OwnImage(photos[k]), static_cast<uint8_t>(k + 1), {}, &maps);
  }
  return maps;
}

double ShareFilled(const CoherentMaps& maps, size_t images) {
  double filled = 0, atlas = 0;
  for (size_t i = 0; i < maps.from.size(); ++i) {
    atlas += maps.texel_parts[i] != 0 ? 1 : 0;
    filled += maps.from[i] != 0 && maps.from[i] <= images ? 1 : 0;
  }
  return filled / std::max(1.0, atlas);
}

PseudoImage LookUp(const CoherentMaps& maps, const PhotoFrame& frame) {
  const size_t texels = maps.from.size(), pixels = size_t(frame.size) * frame.size;
  BODYLOOM_CHECK(frame.uv.size() == 2 * pixels && frame.parts.size() == pixels, "coherent maps: a frame of ",
                 frame.size, " px has ", frame.uv.size(), " coordinates and ", frame.parts.size(), " parts");
  PseudoImage pseudo{frame.size,
                     std::vector<float>(3 * pixels),
                     std::vector<uint8_t>(pixels),
                     std::vector<uint8_t>(pixels),
                     std::vector<float>(maps.clothes_offset.empty() ? 0 : pixels),
                     {}};
  const auto size = static_cast<float>(maps.size);
  for (size_t i = 0; i < pixels; ++i) {
    const uint8_t part = frame.parts[i];
    if (part == 0) continue;
    const Around around = AroundPoint(frame.uv[i] * size - 0.5F, (1 - frame.uv[pixels + i]) * size - 0.5F, maps.size);
    float all = 0, weight = 0, heaviest = 0, clothes_offset = 0;
    std::array<float, 3> colour{};
    uint8_t label = 0;
    for (size_t k = 0; k < 4; ++k) {
      const size_t texel = around.index[k];
      if (maps.texel_parts[texel] != part) continue;
      const float w = around.weight[k];
      all += w;
      if (!maps.clothes_offset.empty()) clothes_offset += w * maps.clothes_offset[texel];
      if (maps.from[texel] == 0) continue;
      weight += w;
      for (size_t c = 0; c < 3; ++c) colour[c] += w * maps.appearance[c * texels + texel];
      if (w > heaviest) {
        heaviest = w;
        label = maps.labels[texel];
      }
    }
    if (!pseudo.clothes_offset.empty() && all > 0) pseudo.clothes_offset[i] = clothes_offset / all;
    if (!(weight > 0) || weight < 0.5F * all) continue;
    for (size_t c = 0; c < 3; ++c) pseudo.image[c * pixels + i] = colour[c] / weight;
    pseudo.labels[i] = label;
    pseudo.known[i] = 1;
  }
  if (!maps.clothes_offset.empty()) pseudo.clothed = ClothedBody(frame, pseudo.clothes_offset);
  return pseudo;
}

}  // namespace bodyloom
