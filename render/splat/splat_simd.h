// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/splat/splat_image.h and render/splat/splat_gradient.h: Gaussians over the pixels of one
/// tile. Plain arrays in, plain arrays out, compiled once per instruction set like render/raster/raster_simd.h. The
/// same bits from all of them: every operation is one correctly rounded IEEE operation in the order written here, never
/// fused, and sums over pixels are taken per block of sixteen pixels for any vector length.
///
/// At a pixel at offset d from the mean the exponent is, in base 2,
///   t = (log2 o + a d_x²) + d_y (b d_x + c d_y),   a, b, c = −½ log2(e) K_xx, −log2(e) K_xy, −½ log2(e) K_yy
/// The Gaussian is blended if t ≥ log2(1/255) and the transmittance T ≥ stop, with α = min(0.99, 2^t), w = α T:
///   colour += w · colour of the Gaussian,   T −= w
///
/// Backward pass, front to back again, with g and g_T the derivatives by colour and by 1 − T, and `rest` the
/// contribution of what lies behind (initially colour · g + (1 − T) g_T of the finished image):
///   k = colour of the Gaussian · g + g_T,   rest −= w k,   D = w k − rest α/(1 − α)   (0 where α was cut to 0.99)
/// D is α d loss / d α. A Gaussian's derivatives follow from the sums of D and of w g over the tile.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bodyloom::splat_internal {

inline constexpr int kTileSize = 16;  ///< pixels, both ways
inline constexpr int kTilePixels = kTileSize * kTileSize;
inline constexpr int kBlockSize = 4;  ///< a vector is 4×4 pixels: small Gaussians fill it better than a row
inline constexpr int kBlockPixels = kBlockSize * kBlockSize;
inline constexpr int kBlocksAcross = kTileSize / kBlockSize, kNumBlocks = kBlocksAcross * kBlocksAcross;
inline constexpr float kMinExponent = -7.99435344F;  ///< log2(1/255)

/// Parameters of a Gaussian for drawing, one cache line.
struct alignas(64) Splat {
  float x, y;     ///< mean, pixels
  float a, b, c;  ///< a, c < 0
  float log2_opacity;
  float minimum;         ///< a block whose maximum exponent minus log2 o is below this has no pixel
  float peak_x, peak_y;  ///< −1/(2a), −1/(2c): a row's maximum exponent is at d_x = peak_x · b · d_y; …
  float red, green, blue;
  float half_width, half_height;  ///< pixels
};

/// A pair of a Gaussian and a tile.
struct SplatEntry {
  int32_t row;   ///< of the Gaussian
  int32_t slot;  ///< backward pass: index of its sums
};

/// The Gaussians that meet a tile, front to back.
struct SplatList {
  const Splat* splats = nullptr;
  const SplatEntry* entries = nullptr;
  int count = 0;
};

/// Index of pixel (x, y) in a tile's arrays, which are stored block by block, each row-major.
inline constexpr int PlaceInTile(int x, int y) {
  return (y / kBlockSize * kBlocksAcross + x / kBlockSize) * kBlockPixels + y % kBlockSize * kBlockSize +
         x % kBlockSize;
}
/// Copies one row of a tile's array to sixteen floats, and back.
inline void RowFromTile(const float* pixels, int y, float* row) {
  for (int x = 0; x < kTileSize; x += kBlockSize) std::copy_n(pixels + PlaceInTile(x, y), kBlockSize, row + x);
}
inline void RowToTile(const float* row, int y, float* pixels) {
  for (int x = 0; x < kTileSize; x += kBlockSize) std::copy_n(row + x, kBlockSize, pixels + PlaceInTile(x, y));
}

/// Copies up to sixteen floats; the common case of sixteen is inlined.
inline void CopyPixels(const float* from, int count, float* to) {
  if (count == kTileSize) {
    std::copy_n(from, kTileSize, to);
  } else {
    std::copy_n(from, count, to);
  }
}

/// State of a tile in the forward pass.
struct SplatTile {
  int x = 0, y = 0;  ///< pixel of its corner
  float stop = 0;
  uint32_t alive = 0xffff;  ///< blocks that may have a pixel of T ≥ stop
  alignas(64) float transmittance[kTilePixels];
  alignas(64) float colour[3][kTilePixels];
};

/// State of a tile in the backward pass.
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

/// Blends a list behind what the tile holds.
void DrawSplats(const SplatList& list, SplatTile* tile);
/// Fills the slot of every entry, kSlotFloats floats from slot·kSlotFloats; zeros for Gaussians that no pixel used.
void DrawSplatsBackward(const SplatList& list, SplatTileBack* tile, float* sums);

}  // namespace bodyloom::splat_internal
