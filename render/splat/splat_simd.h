// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/splat/splat_picture.h and render/splat/splat_gradient.h: Gaussians over the pixels of one
/// tile. Plain arrays in, plain arrays out, compiled once per instruction set like render/raster/raster_simd.h. The
/// same bits from all of them: every operation is one correctly rounded IEEE operation in the order written here, never
/// fused, and sums over pixels are taken by the sixteen pixels of a block whatever the length of a vector.
///
/// A pixel at d from a mean has the exponent, in base 2,
///   t = (log2 o + a d_x²) + d_y (b d_x + c d_y),   a, b, c = −½ log2(e) K_xx, −log2(e) K_xy, −½ log2(e) K_yy
/// It takes the Gaussian when t ≥ log2(1/255) and its transmittance T ≥ stop, with α = min(0.99, 2^t), w = α T:
///   colour += w · colour of the Gaussian,   T −= w
///
/// Backwards, front to back again, with g and g_T the derivatives by colour and by 1 − T, and `rest` what lies behind
/// (at first colour · g + (1 − T) g_T of the finished picture):
///   k = colour of the Gaussian · g + g_T,   rest −= w k,   D = w k − rest α/(1 − α)   (0 where α was cut to 0.99)
/// D is α d loss / d α. Its sums over the tile and those of w g are what a Gaussian gets of it.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bodyloom::splat_internal {

inline constexpr int kTileSize = 16;  ///< pixels, both ways
inline constexpr int kTilePixels = kTileSize * kTileSize;
inline constexpr int kBlockSize = 4;  ///< a vector is 4×4 pixels: spots of a few pixels fill it better than a row
inline constexpr int kBlockPixels = kBlockSize * kBlockSize;
inline constexpr int kBlocksAcross = kTileSize / kBlockSize, kNumBlocks = kBlocksAcross * kBlocksAcross;
inline constexpr float kLeastExponent = -7.99435344F;  ///< log2(1/255)

/// A Gaussian as it is drawn: one cache line.
struct alignas(64) Splat {
  float x, y;     ///< mean, pixels
  float a, b, c;  ///< a, c < 0
  float log2_opacity;
  float least;           ///< a block whose largest exponent less log2 o is below this holds no pixel, for all rounding
  float peak_x, peak_y;  ///< −1/(2a), −1/(2c): a row's largest exponent is at d_x = peak_x · b · d_y; …
  float red, green, blue;
  float half_width, half_height;  ///< pixels
};

/// A meeting of a Gaussian and a tile.
struct SplatEntry {
  int32_t row;   ///< of the Gaussian
  int32_t slot;  ///< backwards: where its sums go
};

/// What meets a tile, front to back.
struct SplatList {
  const Splat* splats = nullptr;
  const SplatEntry* entries = nullptr;
  int count = 0;
};

/// A tile's arrays hold block after block, each row by row: where its pixel (x, y) lies.
inline constexpr int PlaceInTile(int x, int y) {
  return (y / kBlockSize * kBlocksAcross + x / kBlockSize) * kBlockPixels + y % kBlockSize * kBlockSize +
         x % kBlockSize;
}
/// One row of a tile's array to sixteen floats, and back.
inline void RowFromTile(const float* pixels, int y, float* row) {
  for (int x = 0; x < kTileSize; x += kBlockSize) std::copy_n(pixels + PlaceInTile(x, y), kBlockSize, row + x);
}
inline void RowToTile(const float* row, int y, float* pixels) {
  for (int x = 0; x < kTileSize; x += kBlockSize) std::copy_n(row + x, kBlockSize, pixels + PlaceInTile(x, y));
}

/// Up to sixteen floats; sixteen, which most are, without a call.
inline void CopyPixels(const float* from, int count, float* to) {
  if (count == kTileSize) {
    std::copy_n(from, kTileSize, to);
  } else {
    std::copy_n(from, count, to);
  }
}

/// One tile while it is drawn.
struct SplatTile {
  int x = 0, y = 0;  ///< the pixel of its corner
  float stop = 0;
  uint32_t alive = 0xffff;  ///< blocks that may have a pixel of T ≥ stop
  alignas(64) float transmittance[kTilePixels];
  alignas(64) float colour[3][kTilePixels];
};

/// One tile while it is gone through backwards.
struct SplatTileBack {
  int x = 0, y = 0;
  float stop = 0;
  uint32_t alive = 0xffff;
  alignas(64) float transmittance[kTilePixels];
  alignas(64) float rest[kTilePixels];
  alignas(64) float by_colour[3][kTilePixels], by_alpha[kTilePixels];
};

/// Sums of one Gaussian over one tile: D, D d_x, D d_y, D d_x², D d_x d_y, D d_y², w g (3), and three zeros.
inline constexpr int kSlotFloats = 12;

/// Draws a list over what is there.
void DrawSplats(const SplatList& list, SplatTile* tile);
/// Fills the slot of every entry, kSlotFloats floats from slot·kSlotFloats, with zeros where nothing was taken.
void DrawSplatsBackward(const SplatList& list, SplatTileBack* tile, float* sums);

}  // namespace bodyloom::splat_internal
