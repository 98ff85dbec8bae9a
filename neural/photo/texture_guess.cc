// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/texture_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/check.h"
#include "neural/people/body_part_map.h"

namespace bodyloom {
namespace {

constexpr int kFinest = 6;  ///< cells of 1/64 of the extent, 2.7 cm of a person: some texels of a map of 128

struct Mean {
  std::array<double, 3> sum{};
  int count = 0;
};

}  // namespace

TextureGuess::TextureGuess(int texture_size, std::span<const uint8_t> texel_parts, std::span<const float> texel_places)
    : texture_size_(texture_size) {
  const size_t area = static_cast<size_t>(std::max(texture_size, 0)) * static_cast<size_t>(std::max(texture_size, 0));
  BODYLOOM_CHECK(texture_size > 0 && texel_parts.size() == area && texel_places.size() == 3 * area,
                 "texture guess: ", texel_parts.size(), " parts and ", texel_places.size(),
                 " places of texels, expected ", texture_size, "² and 3 x ", texture_size, "²");
  std::array<float, 3> low{}, high{};
  low.fill(std::numeric_limits<float>::max()), high.fill(std::numeric_limits<float>::lowest());
  for (size_t k = 0; k < area; ++k) {
    if (texel_parts[k] == 0) continue;
    BODYLOOM_CHECK(texel_parts[k] < kPhotoParts, "texture guess: part ", int(texel_parts[k]), ", expected 0 to 24");
    for (size_t a = 0; a < 3; ++a) {
      const float x = texel_places[a * area + k];
      BODYLOOM_CHECK(std::isfinite(x), "texture guess: texel ", k, " has no place");
      low[a] = std::min(low[a], x), high[a] = std::max(high[a], x);
    }
    texels_.push_back(static_cast<int>(k));
  }
  if (texels_.empty()) return;
  const double extent =
      std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], std::numeric_limits<float>::min()});
  const double middle = 0.5 * (double(low[0]) + high[0]);
  for (int l = kFinest; l >= 0; --l) {
    Level level;
    std::map<std::array<int, 4>, int> cells;
    const double per_cell = std::ldexp(1.0, l) / extent;
    for (const int k : texels_) {
      const int limb = LimbOf(texel_parts[k]);
      const auto step = [&](double length) { return static_cast<int>(length * per_cell); };
      const std::array<int, 4> cell = {limb, step(std::abs(texel_places[k] - middle)),
                                       step(texel_places[area + k] - low[1]),
                                       limb == kHeadLimb ? step(texel_places[2 * area + k] - low[2]) : 0};
      level.cell.push_back(cells.emplace(cell, static_cast<int>(cells.size())).first->second);
    }
    level.num_cells = static_cast<int>(cells.size());
    levels_.push_back(std::move(level));
  }
  // Coarser than the limb's last cells: the limb as a whole, then everything.
  Level limbs{{}, kLimbs};
  for (const int k : texels_) limbs.cell.push_back(LimbOf(texel_parts[k]));
  levels_.push_back(std::move(limbs));
  levels_.push_back({std::vector<int>(texels_.size(), 0), 1});
}

void TextureGuess::Fill(PartialTexture* texture) const {
  const size_t area = static_cast<size_t>(texture_size_) * static_cast<size_t>(texture_size_);
  BODYLOOM_CHECK(
      texture->size == texture_size_ && texture->visible.size() == area && texture->colour.size() == 3 * area,
      "texture guess: a texture of ", texture->size, " texels a side, expected ", texture_size_);
  texture->guessed.assign(area, 0);
  std::vector<std::vector<Mean>> means;
  for (const Level& level : levels_) {
    std::vector<Mean>& mean = means.emplace_back(level.num_cells);
    for (size_t i = 0; i < texels_.size(); ++i) {
      if (texture->visible[texels_[i]] == 0) continue;
      Mean& of_cell = mean[level.cell[i]];
      ++of_cell.count;
      for (size_t c = 0; c < 3; ++c) of_cell.sum[c] += texture->colour[c * area + texels_[i]];
    }
  }
  for (size_t i = 0; i < texels_.size(); ++i) {
    const int k = texels_[i];
    if (texture->visible[k] != 0) continue;
    for (size_t l = 0; l < levels_.size(); ++l) {
      const Mean& mean = means[l][levels_[l].cell[i]];
      if (mean.count == 0) continue;
      texture->guessed[k] = 1;
      for (size_t c = 0; c < 3; ++c) texture->colour[c * area + k] = static_cast<float>(mean.sum[c] / mean.count);
      break;
    }
  }
}

}  // namespace bodyloom
