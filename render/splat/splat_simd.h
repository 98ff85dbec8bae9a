// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/splat/splat_picture.h and render/splat/splat_gradient.h: Gaussians over the pixels of one
/// tile. Plain arrays in, plain arrays out, compiled once per instruction set like render/raster_simd.h. The same bits
/// from all of them: every operation is one correctly rounded IEEE operation in the order written here, never fused, and
/// sums over pixels are taken by the sixteen columns of a tile whatever the length of a vector.
///
/// A pixel at d from a mean has the exponent, in base 2,
///   t = (log2 o + c d_y²) + d_x (b d_y + a d_x),   a, b, c = −½ log2(e) K_xx, −log2(e) K_xy, −½ log2(e) K_yy
/// It takes the Gaussian when t ≥ log2(1/255) and its transmittance T ≥ stop, with α = min(0.99, 2^t), w = α T:
///   colour += w · colour of the Gaussian,   T −= w
///
/// Backwards, front to back again, with g and g_T the derivatives by colour and by 1 − T, and `rest` what lies behind
/// (at first colour · g + (1 − T) g_T of the finished picture):
///   k = colour of the Gaussian · g + g_T,   rest −= w k,   D = w k − rest α/(1 − α)   (0 where α was cut to 0.99)
/// D is α d loss / d α. Its sums over the tile and those of w g are what a Gaussian gets of it.
#pragma once

#include <cstdint>

namespace bodyloom::splat_internal {

inline constexpr int kTileSize = 16;  ///< pixels, both ways
inline constexpr int kTilePixels = kTileSize * kTileSize;
inline constexpr float kLeastExponent = -7.99435344F;  ///< log2(1/255)

/// A Gaussian's outline.
struct alignas(32) SplatShape {
  float x, y;     ///< mean, pixels
  float a, b, c;  ///< a, c < 0
  float log2_opacity;
  float peak;   ///< −1/(2a): a row's largest exponent is at d_x = peak · b · d_y
  float least;  ///< a row whose largest exponent is below this holds no pixel, for all rounding
};

struct alignas(16) SplatPaint {
  float red, green, blue, unused;
};

/// What meets a tile, front to back.
struct SplatList {
  const SplatShape* shapes = nullptr;
  const SplatPaint* paints = nullptr;
  const int32_t* ranks = nullptr;  ///< indices into the two
  const int32_t* slots = nullptr;  ///< backwards only: where each one's sums go
  int count = 0;
};

/// One tile while it is drawn. Pixels row-major.
struct SplatTile {
  int x = 0, y = 0;  ///< the pixel of its corner
  float stop = 0;
  uint32_t alive = 0xffff;  ///< rows that may have a pixel of T ≥ stop
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
/// Fills the slot of every entry, kSlotFloats floats from slots[i]·kSlotFloats, with zeros where nothing was taken.
void DrawSplatsBackward(const SplatList& list, SplatTileBack* tile, float* sums);

}  // namespace bodyloom::splat_internal
