// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/partial_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "render/texture/complete/guess_unseen.h"

namespace bodyloom {
namespace {

size_t Area(int side) { return static_cast<size_t>(side) * static_cast<size_t>(side); }

void CheckSizes(const PhotoFrame& frame) {
  const size_t pixels = Area(frame.size), texels = Area(frame.texture_size);
  BODYLOOM_CHECK(
      frame.size > 0 && frame.image.size() == 3 * pixels && (frame.labels.empty() || frame.labels.size() == pixels),
      "partial texture: an image of ", frame.image.size(), " values with ", frame.labels.size(),
      " labels, expected 3 x ", frame.size, "² and ", frame.size, "²");
  BODYLOOM_CHECK(
      frame.texture_size > 0 && frame.texel_pixels.size() == 2 * texels && frame.texel_cosine.size() == texels,
      "partial texture: ", frame.texel_pixels.size(), " places and ", frame.texel_cosine.size(),
      " texels, expected 2 x ", frame.texture_size, "² and ", frame.texture_size, "²");
}

void CheckSame(const PartialTexture& a, const PartialTexture& b) {
  BODYLOOM_CHECK(a.size == b.size && a.colour.size() == 3 * Area(a.size) && a.visible.size() == Area(a.size) &&
                     b.colour.size() == a.colour.size() && b.visible.size() == a.visible.size() &&
                     a.labels.size() == Area(a.size) && b.labels.size() == a.labels.size() &&
                     a.cosine.size() == Area(a.size) && b.cosine.size() == a.cosine.size(),
                 "partial textures of ", a.size, " and ", b.size, " texels a side, expected the same");
  BODYLOOM_CHECK(a.guessed.empty() && b.guessed.empty(), "partial textures with guesses, expected what is seen alone");
}

void CopyTexel(const PartialTexture& from, size_t texel, PartialTexture* to) {
  const size_t texels = to->visible.size();
  to->visible[texel] = from.visible[texel];
  to->labels[texel] = from.labels[texel];
  to->cosine[texel] = from.cosine[texel];
  for (size_t c = 0; c < 3; ++c) to->colour[c * texels + texel] = from.colour[c * texels + texel];
}

}  // namespace

PartialTexture PartialTextureOf(const PhotoFrame& frame) {
  CheckSizes(frame);
  const size_t pixels = Area(frame.size), texels = Area(frame.texture_size);
  const int S = frame.size;
  const auto shows_person = [&](int x, int y) {
    if (x < 0 || x >= S || y < 0 || y >= S) return false;
    const size_t i = static_cast<size_t>(y) * S + x;
    if (!frame.labels.empty()) return frame.labels[i] != 0;
    return frame.image[i] > 0 || frame.image[pixels + i] > 0 || frame.image[2 * pixels + i] > 0;
  };
  PartialTexture texture;
  texture.size = frame.texture_size;
  texture.colour.assign(3 * texels, 0);
  texture.visible.assign(texels, 0);
  texture.labels.assign(texels, 0);
  texture.cosine.assign(texels, 0);
  for (size_t k = 0; k < texels; ++k) {
    const float x = frame.texel_pixels[k], y = frame.texel_pixels[texels + k];
    if (frame.texel_cosine[k] == 0 || !(std::abs(x) < 2 * S && std::abs(y) < 2 * S)) continue;
    const int nearest_x = static_cast<int>(std::floor(x + 0.5F)), nearest_y = static_cast<int>(std::floor(y + 0.5F));
    if (!shows_person(nearest_x, nearest_y)) continue;
    const float x0 = std::floor(x), y0 = std::floor(y);
    float weight = 0;
    std::array<float, 3> colour = {};
    for (const int corner : {0, 1, 2, 3}) {
      const int dx = corner % 2, dy = corner / 2;
      const int px = static_cast<int>(x0) + dx, py = static_cast<int>(y0) + dy;
      if (!shows_person(px, py)) continue;
      const float w = (dx == 1 ? x - x0 : 1 - (x - x0)) * (dy == 1 ? y - y0 : 1 - (y - y0));
      weight += w;
      const size_t i = static_cast<size_t>(py) * S + px;
      for (size_t c = 0; c < 3; ++c) colour[c] += w * frame.image[c * pixels + i];
    }
    texture.visible[k] = 1;
    texture.labels[k] = frame.labels.empty() ? 1 : frame.labels[static_cast<size_t>(nearest_y) * S + nearest_x];
    texture.cosine[k] = frame.texel_cosine[k];
    for (size_t c = 0; c < 3; ++c) texture.colour[c * texels + k] = colour[c] / weight;
  }
  return texture;
}

PartialTexture WithParts(const PartialTexture& texture, const PartialTexture& garment,
                         std::span<const uint8_t> texel_parts, std::span<const int> parts) {
  CheckSame(texture, garment);
  BODYLOOM_CHECK(texel_parts.size() == texture.visible.size(), "partial texture: parts of ", texel_parts.size(),
                 " texels, expected ", texture.visible.size());
  PartialTexture result = texture;
  for (size_t k = 0; k < texel_parts.size(); ++k) {
    if (std::find(parts.begin(), parts.end(), texel_parts[k]) != parts.end()) CopyTexel(garment, k, &result);
  }
  return result;
}

PartialTexture UnionOf(std::span<const PartialTexture> textures) {
  BODYLOOM_CHECK(!textures.empty(), "partial texture: the union of no textures");
  PartialTexture result = textures[0];
  for (const PartialTexture& texture : textures.subspan(1)) {
    CheckSame(result, texture);
    for (size_t k = 0; k < result.visible.size(); ++k) {
      if (texture.cosine[k] > result.cosine[k]) CopyTexel(texture, k, &result);
    }
  }
  return result;
}

double VisibleShare(const PartialTexture& texture, std::span<const uint8_t> texel_parts) {
  BODYLOOM_CHECK(texel_parts.size() == texture.visible.size(), "partial texture: parts of ", texel_parts.size(),
                 " texels, expected ", texture.visible.size());
  size_t all = 0, visible = 0;
  for (size_t k = 0; k < texel_parts.size(); ++k) {
    if (texel_parts[k] == 0) continue;
    ++all;
    visible += texture.visible[k];
  }
  return all > 0 ? static_cast<double>(visible) / static_cast<double>(all) : 0;
}

void GuessTexture(const TexelNeighbours& neighbours, PartialTexture* texture) {
  BODYLOOM_CHECK(texture->size == neighbours.texture_size(), "texture guess: a texture of ", texture->size,
                 " texels a side, expected ", neighbours.texture_size());
  std::vector<uint8_t> labels = texture->labels;
  RelabelBackOfHeadAsHair(neighbours.back_of_head(), labels);
  texture->guessed = GuessUnseen(neighbours, labels, texture->colour);
}

}  // namespace bodyloom
