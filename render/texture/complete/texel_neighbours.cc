// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/texel_neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "geometry/base/check.h"
#include "render/texture/complete/body_part_map.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {
namespace {

constexpr int kFinest = 6;  ///< cells of 1/64 of the extent, 2.7 cm of a person: some texels of a map of 128

}  // namespace

TexelNeighbours::TexelNeighbours(int texture_size, std::span<const uint8_t> texel_parts,
                                 std::span<const float> texel_places)
    : texture_size_(texture_size) {
  const size_t area = static_cast<size_t>(std::max(texture_size, 0)) * static_cast<size_t>(std::max(texture_size, 0));
  BODYLOOM_CHECK(texture_size > 0 && texel_parts.size() == area && texel_places.size() == 3 * area,
                 "texel neighbours: ", texel_parts.size(), " parts and ", texel_places.size(),
                 " places of texels, expected ", texture_size, "² and 3 x ", texture_size, "²");
  std::array<float, 3> low{}, high{};
  low.fill(std::numeric_limits<float>::max()), high.fill(std::numeric_limits<float>::lowest());
  for (size_t k = 0; k < area; ++k) {
    if (texel_parts[k] == 0) continue;
    BODYLOOM_CHECK(texel_parts[k] < kPhotoParts, "texel neighbours: part ", int(texel_parts[k]), ", expected 0 to 24");
    for (size_t a = 0; a < 3; ++a) {
      const float x = texel_places[a * area + k];
      BODYLOOM_CHECK(std::isfinite(x), "texel neighbours: texel ", k, " has no place");
      low[a] = std::min(low[a], x), high[a] = std::max(high[a], x);
    }
    texels_.push_back(static_cast<int>(k));
  }
  head_.assign(area, 0), back_of_head_.assign(area, 0);
  if (texels_.empty()) return;
  HeadTexels of_head = HeadTexelsOf(texel_parts, texel_places);
  head_ = std::move(of_head.head), back_of_head_ = std::move(of_head.back);
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
  // Two coarser levels: the whole limb, then the whole body.
  Level limbs{{}, kLimbs};
  for (const int k : texels_) limbs.cell.push_back(LimbOf(texel_parts[k]));
  levels_.push_back(std::move(limbs));
  levels_.push_back({std::vector<int>(texels_.size(), 0), 1});
}

std::vector<uint8_t> TexelNeighbours::FillUnseen(std::span<const uint8_t> shown, int channels,
                                                 std::span<float> values) const {
  const size_t area = static_cast<size_t>(texture_size_) * static_cast<size_t>(texture_size_);
  const auto C = static_cast<size_t>(std::max(channels, 0));
  BODYLOOM_CHECK(shown.size() == area && channels > 0 && values.size() == C * area, "texel neighbours: ", shown.size(),
                 " texels with ", values.size(), " values of ", channels, " channels, expected ", texture_size_,
                 " texels a side");
  struct Cells {
    std::vector<double> sum;  ///< cell, channel
    std::vector<int> count;
  };
  std::vector<Cells> of_levels;
  for (const Level& level : levels_) {
    Cells& cells =
        of_levels.emplace_back(Cells{std::vector<double>(C * level.num_cells), std::vector<int>(level.num_cells)});
    for (size_t i = 0; i < texels_.size(); ++i) {
      if (shown[texels_[i]] == 0) continue;
      ++cells.count[level.cell[i]];
      for (size_t c = 0; c < C; ++c) cells.sum[C * level.cell[i] + c] += values[c * area + texels_[i]];
    }
  }
  std::vector<uint8_t> filled(area);
  for (size_t i = 0; i < texels_.size(); ++i) {
    const int k = texels_[i];
    if (shown[k] != 0) continue;
    for (size_t l = 0; l < levels_.size(); ++l) {
      const Cells& cells = of_levels[l];
      const size_t cell = levels_[l].cell[i];
      if (cells.count[cell] == 0) continue;
      filled[k] = 1;
      for (size_t c = 0; c < C; ++c) {
        values[c * area + k] = static_cast<float>(cells.sum[C * cell + c] / cells.count[cell]);
      }
      break;
    }
  }
  return filled;
}

}  // namespace bodyloom
