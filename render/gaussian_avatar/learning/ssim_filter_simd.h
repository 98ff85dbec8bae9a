// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/gaussian_avatar/learning/image_loss.h: a Gaussian window along rows and columns, and SSIM
/// with its derivatives. Plain arrays in, plain arrays out, compiled once per instruction set like
/// render/raster/raster_simd.h; the same bits from all of them: products and sums in the order written, never fused.
#pragma once

#include <array>

namespace bodyloom::avatar_internal {

inline constexpr int kSsimRadius = 5;
inline constexpr int kSsimTaps = 2 * kSsimRadius + 1;
inline constexpr int kSsimLanes = 16;  ///< floats of a row filtered at once

/// w_0 .. w_radius of a normalised, symmetric Gaussian window of σ 1.5.
std::array<float, kSsimRadius + 1> SsimWindow();

/// out[x] = Σ_t w_t in[x + t − radius] for x < n rounded up to whole lanes; `in` is read from −radius to that + radius.
void FilterSsimRow(const float* in, const float* half, int n, float* out);

/// out[x] = Σ_t w_t lines[t][x] for x < n rounded up to whole lanes.
void FilterSsimColumn(const float* const* lines, const float* half, int n, float* out);

/// out[x] = a² + b², products[x] = a b, for x < n rounded up to whole lanes.
void SsimProducts(const float* a, const float* b, int n, float* squares, float* products);

/// Computes SSIM (white is 1) and its derivatives by the first, third and fourth moment from the windows' means of a,
/// b, a² + b² and ab.
void SsimOfMoments(const float* const moments[4], int n, float* ssim, float* const by_moments[3]);

}  // namespace bodyloom::avatar_internal
