// SPDX-License-Identifier: Apache-2.0
/// Assigns Gaussians to the tiles of the screen, front to back.
///
/// Tiles of 16×16 pixels have corners at multiples of 16 in any window, so that a pixel's value does not depend on the
/// window. Gaussians in the order of depth (their rank) are divided into chunks that depend on their number alone; each
/// chunk is sorted into tiles independently, in parallel, and a tile is drawn chunk by chunk.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/image/pixel_box.h"
#include "render/splat/camera_gaussians.h"
#include "render/splat/splat_simd.h"

namespace bodyloom {

// Front-to-back order by a stable radix sort.

/// Keeps its memory between calls.
class DepthOrder {
 public:
  /// Sorts `rows`, indices into depth, by depth[row] ascending, stable for equal depths (0 and −0 differ). O(n): one
  /// pass per 11 bits in which the depths differ, at most three. The depths must not be NaN. The result is valid until
  /// the next call.
  std::span<const int32_t> Sort(std::span<const float> depth, std::span<const int32_t> rows);

 private:
  struct Item {
    uint32_t key;
    int32_t row;
  };
  std::vector<Item> items_, other_;
  std::vector<int32_t> sorted_;
};

}  // namespace bodyloom

namespace bodyloom::splat_internal {

/// Keeps its memory between images. Call Begin(), PackRows() for every batch of rows from any thread, Order(),
/// SortChunk() for every chunk from any thread, and End() before the accessors.
class SplatTiles {
 public:
  void Begin(const ScreenGaussians& screen, const PixelBox& window);
  [[nodiscard]] int num_batches() const;
  /// Collects the drawn Gaussians of a batch that meet the window.
  void PackRows(const ScreenGaussians& screen, int batch);
  /// Ranks the collected Gaussians by depth.
  void Order(const ScreenGaussians& screen);
  [[nodiscard]] int num_chunks() const { return static_cast<int>(num_chunks_); }
  void SortChunk(int chunk);
  /// Assigns slot numbers (render/splat/splat_simd.h) to all chunks.
  void End();

  [[nodiscard]] const PixelBox& window() const { return window_; }
  [[nodiscard]] int num_tiles() const { return tiles_across_ * tiles_down_; }
  /// The pixels of a tile, and those of them in the window.
  [[nodiscard]] PixelBox BoxOf(int tile) const;
  [[nodiscard]] PixelBox PixelsOf(int tile) const { return BoxOf(tile).ClippedTo(window_); }
  /// The Gaussians of one chunk that meet a tile; slots are relative to first_slot(chunk).
  [[nodiscard]] SplatList ListOf(int tile, int chunk) const;
  [[nodiscard]] int first_slot(int chunk) const { return chunks_[chunk].first_slot; }

  /// Rows of the Gaussians by rank.
  [[nodiscard]] std::span<const int32_t> order() const { return order_; }
  /// By row; only rows in order() are set.
  [[nodiscard]] const std::vector<Splat>& splats() const { return splats_; }
  [[nodiscard]] int num_slots() const { return num_slots_; }
  /// Slots of a rank: SlotsOf(rank).first to .second − 1.
  [[nodiscard]] std::pair<int, int> SlotsOf(int rank) const;

 private:
  struct Chunk {
    [[nodiscard]] int num_slots() const { return slot_begin.back(); }

    int first = 0, last = 0;  ///< ranks
    int first_slot = 0;
    std::vector<int32_t> begin;  ///< by tile
    std::vector<SplatEntry> entries;
    /// By slot, with spare capacity; slots ascend with the rank.
    std::vector<int32_t> tile_of_slot, row_of_slot;
    std::vector<int32_t> slot_begin;  ///< by rank, followed by the number of slots
  };

  PixelBox window_;
  int tile_left_ = 0, tile_top_ = 0, tiles_across_ = 0, tiles_down_ = 0;  ///< in tiles
  DepthOrder depth_order_;
  std::vector<int32_t> met_, num_met_;  ///< rows that meet the window, batch by batch, and their number per batch
  std::span<const int32_t> order_;
  std::vector<Splat> splats_;  ///< by row, for drawn Gaussians
  int num_rows_ = 0, chunk_bits_ = 0;
  [[nodiscard]] PixelBox TilesOf(const Splat& splat) const;

  std::vector<Chunk> chunks_;
  size_t num_chunks_ = 0;
  int num_slots_ = 0;
};

}  // namespace bodyloom::splat_internal
