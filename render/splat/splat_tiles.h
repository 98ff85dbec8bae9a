// SPDX-License-Identifier: Apache-2.0
/// Which Gaussians meet which tile of the screen, front to back.
///
/// Tiles of 16×16 pixels lie on the whole screen's grid: a tile has its corner at multiples of 16, whatever the window,
/// so a pixel sees the same in every window. Gaussians in the order of their depth (their rank) are cut into chunks
/// that depend on their number alone; each chunk is sorted into tiles by itself, on a thread of its own, and a tile is
/// drawn chunk after chunk.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/image/pixel_box.h"
#include "render/splat/camera_gaussians.h"
#include "render/splat/splat_simd.h"

namespace bodyloom {

// Front to back: a stable radix sort by depth.

/// Keeps its memory between calls.
class DepthOrder {
 public:
  /// `rows`, indices into depth, ordered by depth[row]: smaller first, equal ones (0 and −0 are not) as they were.
  /// O(n): one pass for every 11 bits in which the depths differ, three at most. The depths must not be NaN. The
  /// answer lives until the next call.
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

/// Keeps its memory between pictures. First Begin(), then PackRows() for every batch of rows, by any thread, Order(),
/// SortChunk() for every chunk, by any thread, End(), then the rest.
class SplatTiles {
 public:
  void Begin(const ScreenGaussians& screen, const PixelBox& window);
  [[nodiscard]] int num_batches() const;
  /// Finds what is drawn and meets the window, and gathers its numbers.
  void PackRows(const ScreenGaussians& screen, int batch);
  /// Ranks it.
  void Order(const ScreenGaussians& screen);
  [[nodiscard]] int num_chunks() const { return static_cast<int>(num_chunks_); }
  void SortChunk(int chunk);
  /// Numbers the slots (render/splat/splat_simd.h) of all chunks.
  void End();

  [[nodiscard]] const PixelBox& window() const { return window_; }
  [[nodiscard]] int num_tiles() const { return tiles_across_ * tiles_down_; }
  /// The pixel of a tile's corner, and its pixels that lie in the window.
  [[nodiscard]] PixelBox BoxOf(int tile) const;
  [[nodiscard]] PixelBox PixelsOf(int tile) const { return BoxOf(tile).ClippedTo(window_); }
  /// Of one chunk; its slots count from first_slot(chunk).
  [[nodiscard]] SplatList ListOf(int tile, int chunk) const;
  [[nodiscard]] int first_slot(int chunk) const { return chunks_[chunk].first_slot; }

  /// Rows of the Gaussians by rank.
  [[nodiscard]] std::span<const int32_t> order() const { return order_; }
  /// By row; only those in order() hold anything.
  [[nodiscard]] const std::vector<Splat>& splats() const { return splats_; }
  [[nodiscard]] int num_slots() const { return num_slots_; }
  /// The slots of a rank are SlotsOf(rank).first to .second − 1.
  [[nodiscard]] std::pair<int, int> SlotsOf(int rank) const;

 private:
  struct Chunk {
    [[nodiscard]] int num_slots() const { return slot_begin.back(); }

    int first = 0, last = 0;  ///< ranks
    int first_slot = 0;
    std::vector<int32_t> begin;  ///< by tile
    std::vector<SplatEntry> entries;
    /// By slot, with room to spare; slots rise with the rank.
    std::vector<int32_t> tile_of_slot, row_of_slot;
    std::vector<int32_t> slot_begin;  ///< by rank, and their number at the end
  };

  PixelBox window_;
  int tile_left_ = 0, tile_top_ = 0, tiles_across_ = 0, tiles_down_ = 0;  ///< in tiles
  DepthOrder depth_order_;
  std::vector<int32_t> met_, num_met_;  ///< rows, batch by batch, and how many of each batch
  std::span<const int32_t> order_;
  std::vector<Splat> splats_;  ///< by row; of those that are drawn
  int num_rows_ = 0, chunk_bits_ = 0;
  [[nodiscard]] PixelBox TilesOf(const Splat& splat) const;

  std::vector<Chunk> chunks_;
  size_t num_chunks_ = 0;
  int num_slots_ = 0;
};

}  // namespace bodyloom::splat_internal
