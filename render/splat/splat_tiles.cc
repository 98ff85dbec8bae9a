// SPDX-License-Identifier: Apache-2.0
#include "render/splat/splat_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace bodyloom::splat_internal {
namespace {

using Screen = ScreenGaussians;

constexpr int kRowsABatch = 1024;
constexpr int kRanksAhead = 8;     // prefetch distance: neighbours in depth lie far apart in memory
constexpr int kMinChunkBits = 12;  // 4,096 ranks
constexpr int kMaxChunks = 8;      // each keeps a table as long as the image has tiles
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
  s.half_width = screen(row, Screen::kHalfWidth), s.half_height = screen(row, Screen::kHalfHeight);
  // Rounding errors grow with the terms of the exponent, which cancel for oblique, thin Gaussians.
  const float width = s.half_width + kTileSize, height = s.half_height + kTileSize;
  const float slack = 0.01F - 2e-6F * (s.a * (width * width) + s.c * (height * height));
  s.minimum = kMinExponent - s.log2_opacity - slack;
  s.red = screen(row, Screen::kRed), s.green = screen(row, Screen::kGreen), s.blue = screen(row, Screen::kBlue);
  return s;
}

}  // namespace

void SplatTiles::Begin(const ScreenGaussians& screen, const PixelBox& window) {
  window_ = window;
  num_slots_ = 0;
  tile_left_ = window.x_begin >> kTileBits, tile_top_ = window.y_begin >> kTileBits;
  tiles_across_ = window.empty() ? 0 : ((window.x_end - 1) >> kTileBits) - tile_left_ + 1;
  tiles_down_ = window.empty() ? 0 : ((window.y_end - 1) >> kTileBits) - tile_top_ + 1;

  num_rows_ = screen.size();
  splats_.resize(num_rows_), met_.resize(num_rows_), num_met_.resize(num_batches());
}

int SplatTiles::num_batches() const { return (num_rows_ + kRowsABatch - 1) / kRowsABatch; }

void SplatTiles::PackRows(const ScreenGaussians& screen, int batch) {
  const int first = batch * kRowsABatch, last = std::min(num_rows_, first + kRowsABatch);
  int count = 0;
  if (!window_.empty()) {
    const float *x = screen.columns.column(Screen::kMeanX), *y = screen.columns.column(Screen::kMeanY),
                *half_width = screen.columns.column(Screen::kHalfWidth),
                *half_height = screen.columns.column(Screen::kHalfHeight);
    const auto left = static_cast<float>(window_.x_begin), right = static_cast<float>(window_.x_end - 1),
               top = static_cast<float>(window_.y_begin), bottom = static_cast<float>(window_.y_end - 1);
    for (int i = first; i < last; ++i) {
      const bool meets = (half_width[i] > 0) & (x[i] + half_width[i] >= left) & (x[i] - half_width[i] <= right) &
                         (y[i] + half_height[i] >= top) & (y[i] - half_height[i] <= bottom);
      if (!meets) continue;
      splats_[i] = SplatOf(screen.columns, i);
      met_[first + count++] = i;
    }
  }
  num_met_[batch] = count;
}

void SplatTiles::Order(const ScreenGaussians& screen) {
  int count = 0;
  for (int batch = 0; batch < num_batches(); ++batch) {
    std::copy_n(met_.begin() + static_cast<int64_t>(batch) * kRowsABatch, num_met_[batch], met_.begin() + count);
    count += num_met_[batch];
  }
  order_ = depth_order_.Sort(screen.columns.values(Screen::kDepth), {met_.data(), static_cast<size_t>(count)});
  chunk_bits_ = kMinChunkBits;
  while ((count - 1) >> chunk_bits_ >= kMaxChunks) ++chunk_bits_;
  const int ranks_a_chunk = 1 << chunk_bits_;
  num_chunks_ = (count + ranks_a_chunk - 1) / ranks_a_chunk;
  if (chunks_.size() < num_chunks_) chunks_.resize(num_chunks_);
  for (size_t c = 0; c < num_chunks_; ++c) {
    chunks_[c].first = static_cast<int>(c) * ranks_a_chunk;
    chunks_[c].last = std::min(count, chunks_[c].first + ranks_a_chunk);
  }
}

PixelBox SplatTiles::TilesOf(const Splat& s) const {
  // Tiles of the pixels whose centres lie within the extents.
  const auto first = [](float low, int begin) { return std::max(0, (-FloorToInt(-low) >> kTileBits) - begin); };
  const auto last = [](float high, int begin, int count) {
    return std::min(count - 1, (FloorToInt(high) >> kTileBits) - begin);
  };
  return {first(s.x - s.half_width, tile_left_), first(s.y - s.half_height, tile_top_),
          last(s.x + s.half_width, tile_left_, tiles_across_) + 1,
          last(s.y + s.half_height, tile_top_, tiles_down_) + 1};
}

void SplatTiles::SortChunk(int index) {
  Chunk& chunk = chunks_[index];
  chunk.slot_begin.resize(chunk.last - chunk.first + 1);
  size_t num_slots = 0;
  for (int rank = chunk.first; rank < chunk.last; ++rank) {
    __builtin_prefetch(&splats_[order_[std::min(rank + kRanksAhead, chunk.last - 1)]]);
    const int row = order_[rank];
    const PixelBox tiles = TilesOf(splats_[row]);
    chunk.slot_begin[rank - chunk.first] = static_cast<int32_t>(num_slots);
    const size_t room = num_slots + std::max<size_t>(4, tiles.area());
    if (chunk.tile_of_slot.size() < room) {
      chunk.tile_of_slot.resize(2 * room), chunk.row_of_slot.resize(2 * room);
    }
    int32_t *tile_of_slot = chunk.tile_of_slot.data(), *row_of_slot = chunk.row_of_slot.data();
    const int first = tiles.y_begin * tiles_across_ + tiles.x_begin;
    if (tiles.width() <= 2 && tiles.height() <= 2 && !tiles.empty()) {
      // The common case, without an unpredictable branch.
      const size_t two_across = tiles.width() - 1, two_down = tiles.height() - 1;
      for (int k = 0; k < 4; ++k) row_of_slot[num_slots + k] = row;
      tile_of_slot[num_slots++] = first;
      tile_of_slot[num_slots] = first + 1;
      num_slots += two_across;
      tile_of_slot[num_slots] = first + tiles_across_;
      num_slots += two_down;
      tile_of_slot[num_slots] = first + tiles_across_ + 1;
      num_slots += two_across & two_down;
      continue;
    }
    for (int y = 0; y < tiles.height(); ++y) {
      for (int x = 0; x < tiles.width(); ++x, ++num_slots) {
        tile_of_slot[num_slots] = first + y * tiles_across_ + x;
        row_of_slot[num_slots] = row;
      }
    }
  }
  chunk.slot_begin.back() = static_cast<int32_t>(num_slots);

  const int num_tiles = this->num_tiles();
  chunk.begin.assign(static_cast<size_t>(num_tiles) + 2, 0);
  int32_t* const end = chunk.begin.data() + 1;  // of each tile's entries, once they are all placed
  for (size_t slot = 0; slot < num_slots; ++slot) ++end[chunk.tile_of_slot[slot] + 1];
  for (int t = 0; t < num_tiles; ++t) end[t + 1] += end[t];
  chunk.entries.resize(num_slots);
  for (size_t slot = 0; slot < num_slots; ++slot) {
    chunk.entries[end[chunk.tile_of_slot[slot]]++] = {chunk.row_of_slot[slot], static_cast<int32_t>(slot)};
  }
}

void SplatTiles::End() {
  num_slots_ = 0;
  for (size_t c = 0; c < num_chunks_; ++c) {
    chunks_[c].first_slot = num_slots_;
    num_slots_ += chunks_[c].num_slots();
  }
}

PixelBox SplatTiles::BoxOf(int tile) const {
  const int x = (tile_left_ + tile % tiles_across_) * kTileSize, y = (tile_top_ + tile / tiles_across_) * kTileSize;
  return {x, y, x + kTileSize, y + kTileSize};
}

SplatList SplatTiles::ListOf(int tile, int index) const {
  const Chunk& chunk = chunks_[index];
  const int begin = chunk.begin[tile], count = chunk.begin[tile + 1] - begin;
  return {splats_.data(), chunk.entries.data() + begin, count};
}

std::pair<int, int> SplatTiles::SlotsOf(int rank) const {
  const Chunk& chunk = chunks_[rank >> chunk_bits_];
  const int32_t* begin = chunk.slot_begin.data() + (rank - chunk.first);
  return {chunk.first_slot + begin[0], chunk.first_slot + begin[1]};
}

}  // namespace bodyloom::splat_internal

namespace bodyloom {
namespace {

constexpr int kDigitBits = 11;
constexpr uint32_t kDigits = 1U << kDigitBits;

/// Integer key with the order of the floats.
uint32_t RisingKey(float depth) {
  const auto bits = std::bit_cast<uint32_t>(depth);
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

}  // namespace

std::span<const int32_t> DepthOrder::Sort(std::span<const float> depth, std::span<const int32_t> rows) {
  const size_t count = rows.size();
  items_.resize(count), other_.resize(count), sorted_.resize(count);
  uint32_t minimum = UINT32_MAX, maximum = 0;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t key = RisingKey(depth[rows[i]]);
    items_[i] = {key, rows[i]};
    minimum = std::min(minimum, key), maximum = std::max(maximum, key);
  }
  const uint32_t range = count == 0 ? 0 : maximum - minimum;
  for (int shift = 0; shift < 32 && (range >> shift) != 0; shift += kDigitBits) {
    std::array<uint32_t, kDigits> at{};
    for (const Item& item : items_) ++at[((item.key - minimum) >> shift) % kDigits];
    uint32_t sum = 0;
    for (uint32_t& entry : at) {
      const uint32_t here = entry;
      entry = sum;
      sum += here;
    }
    for (const Item& item : items_) other_[at[((item.key - minimum) >> shift) % kDigits]++] = item;
    items_.swap(other_);
  }
  for (size_t i = 0; i < count; ++i) sorted_[i] = items_[i].row;
  return sorted_;
}

}  // namespace bodyloom
