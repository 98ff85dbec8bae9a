// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/splat/splat_tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bodyloom::splat_internal {
namespace {

using Screen = ScreenGaussians;

constexpr int kLeastRanksAChunk = 4096;
constexpr int kMostChunks = 8;  // each keeps a table as long as the picture has tiles
constexpr int kTileBits = 4;
static_assert(1 << kTileBits == kTileSize);

/// std::floor is a call on a baseline processor.
int FloorToInt(float x) {
  const int towards_zero = static_cast<int>(x);
  return towards_zero - static_cast<int>(x < static_cast<float>(towards_zero));
}

Splat SplatOf(const FloatColumns& screen, int row) {
  constexpr float kLog2E = 1.44269504F;
  Splat s;
  s.x = screen(row, Screen::kMeanX), s.y = screen(row, Screen::kMeanY);
  s.a = -0.5F * kLog2E * screen(row, Screen::kConicXx);
  s.b = -kLog2E * screen(row, Screen::kConicXy);
  s.c = -0.5F * kLog2E * screen(row, Screen::kConicYy);
  s.log2_opacity = screen(row, Screen::kLog2Opacity);
  s.peak_x = -0.5F / s.a, s.peak_y = -0.5F / s.c;
  // Rounding grows with the parts of the exponent, which cancel in a needle that lies oblique.
  const float width = screen(row, Screen::kHalfWidth) + kTileSize,
              height = screen(row, Screen::kHalfHeight) + kTileSize;
  const float slack = 0.01F - 2e-6F * (s.a * (width * width) + s.c * (height * height));
  s.least = kLeastExponent - s.log2_opacity - slack;
  s.red = screen(row, Screen::kRed), s.green = screen(row, Screen::kGreen), s.blue = screen(row, Screen::kBlue);
  return s;
}

}  // namespace

int SplatTiles::RanksAChunk() const {
  const int count = static_cast<int>(order_.size());
  return std::max(kLeastRanksAChunk, (count + kMostChunks - 1) / kMostChunks);
}

void SplatTiles::Begin(const ScreenGaussians& screen, const PixelBox& window) {
  window_ = window;
  num_slots_ = 0;
  tile_left_ = window.x_begin >> kTileBits, tile_top_ = window.y_begin >> kTileBits;
  tiles_across_ = window.empty() ? 0 : ((window.x_end - 1) >> kTileBits) - tile_left_ + 1;
  tiles_down_ = window.empty() ? 0 : ((window.y_end - 1) >> kTileBits) - tile_top_ + 1;

  met_.resize(screen.size());
  int count = 0;
  if (!window.empty()) {
    const float *x = screen.columns.column(Screen::kMeanX), *y = screen.columns.column(Screen::kMeanY),
                *half_width = screen.columns.column(Screen::kHalfWidth),
                *half_height = screen.columns.column(Screen::kHalfHeight);
    const auto left = static_cast<float>(window.x_begin), right = static_cast<float>(window.x_end - 1),
               top = static_cast<float>(window.y_begin), bottom = static_cast<float>(window.y_end - 1);
    for (int i = 0; i < screen.size(); ++i) {
      met_[count] = i;
      const bool meets = (half_width[i] > 0) & (x[i] + half_width[i] >= left) & (x[i] - half_width[i] <= right) &
                         (y[i] + half_height[i] >= top) & (y[i] - half_height[i] <= bottom);
      count += static_cast<int>(meets);
    }
  }
  order_ = depth_order_.Sort(screen.columns.values(Screen::kDepth), {met_.data(), static_cast<size_t>(count)});
  splats_.resize(count);
  const int ranks_a_chunk = RanksAChunk();
  num_chunks_ = (count + ranks_a_chunk - 1) / ranks_a_chunk;
  if (chunks_.size() < num_chunks_) chunks_.resize(num_chunks_);
  for (size_t c = 0; c < num_chunks_; ++c) {
    chunks_[c].first = static_cast<int>(c) * ranks_a_chunk;
    chunks_[c].last = std::min(count, chunks_[c].first + ranks_a_chunk);
  }
}

void SplatTiles::SortChunk(const ScreenGaussians& screen, int index) {
  Chunk& chunk = chunks_[index];
  const int num_tiles = this->num_tiles();
  chunk.begin.assign(static_cast<size_t>(num_tiles) + 2, 0);
  int32_t* const end = chunk.begin.data() + 1;  // of each tile's entries, once they are all placed
  chunk.tile_of_slot.clear();
  chunk.slot_begin.resize(chunk.last - chunk.first + 1);
  const FloatColumns& columns = screen.columns;
  for (int rank = chunk.first; rank < chunk.last; ++rank) {
    const int row = order_[rank];
    splats_[rank] = SplatOf(columns, row);
    chunk.slot_begin[rank - chunk.first] = static_cast<int32_t>(chunk.tile_of_slot.size());
    const float x = splats_[rank].x, y = splats_[rank].y;
    const float half_width = columns(row, Screen::kHalfWidth), half_height = columns(row, Screen::kHalfHeight);
    // The pixels whose centres lie within the extents.
    const auto first_tile = [](float low, int begin) { return std::max(0, (-FloorToInt(-low) >> kTileBits) - begin); };
    const auto last_tile = [](float high, int begin, int count) {
      return std::min(count - 1, (FloorToInt(high) >> kTileBits) - begin);
    };
    const int left = first_tile(x - half_width, tile_left_), top = first_tile(y - half_height, tile_top_);
    const int right = last_tile(x + half_width, tile_left_, tiles_across_),
              bottom = last_tile(y + half_height, tile_top_, tiles_down_);
    for (int down = top; down <= bottom; ++down) {
      for (int across = left; across <= right; ++across) {
        const int tile = down * tiles_across_ + across;
        ++end[tile + 1];
        chunk.tile_of_slot.push_back(tile);
      }
    }
  }
  const auto num_slots = static_cast<int32_t>(chunk.tile_of_slot.size());
  chunk.slot_begin.back() = num_slots;
  for (int t = 0; t < num_tiles; ++t) end[t + 1] += end[t];
  chunk.ranks.resize(num_slots), chunk.slots.resize(num_slots);
  for (int rank = chunk.first; rank < chunk.last; ++rank) {
    for (int slot = chunk.slot_begin[rank - chunk.first]; slot < chunk.slot_begin[rank - chunk.first + 1]; ++slot) {
      const int at = end[chunk.tile_of_slot[slot]]++;
      chunk.ranks[at] = rank;
      chunk.slots[at] = slot;
    }
  }
}

void SplatTiles::End() {
  num_slots_ = 0;
  for (size_t c = 0; c < num_chunks_; ++c) {
    chunks_[c].first_slot = num_slots_;
    num_slots_ += static_cast<int>(chunks_[c].tile_of_slot.size());
  }
}

PixelBox SplatTiles::BoxOf(int tile) const {
  const int x = (tile_left_ + tile % tiles_across_) * kTileSize, y = (tile_top_ + tile / tiles_across_) * kTileSize;
  return {x, y, x + kTileSize, y + kTileSize};
}

SplatList SplatTiles::ListOf(int tile, int index) const {
  const Chunk& chunk = chunks_[index];
  const int begin = chunk.begin[tile], count = chunk.begin[tile + 1] - begin;
  return {splats_.data(), chunk.ranks.data() + begin, chunk.slots.data() + begin, count};
}

std::pair<int, int> SplatTiles::SlotsOf(int rank) const {
  const Chunk& chunk = chunks_[rank / RanksAChunk()];
  const int32_t* begin = chunk.slot_begin.data() + (rank - chunk.first);
  return {chunk.first_slot + begin[0], chunk.first_slot + begin[1]};
}

}  // namespace bodyloom::splat_internal
