// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/avatar/motion/uv_convolution.h. Plain arrays in, plain arrays out, compiled once per
/// instruction set like render/raster_simd.h. The same bits from all of them: products and sums are never fused, and every
/// sum is taken in the order written here, by one lane.
#pragma once

#include <cstddef>

namespace bodyloom::motion_internal {

inline constexpr int kConvolutionChannels = 16;  ///< channels come in multiples of this
inline constexpr int kConvolutionTexels = 8;     ///< texels of a row likewise

/// One texel of a kernel: where it reads for the first texel of the row, and its weights, in_channels × out_channels.
struct ConvolutionTap {
  const float* source;
  const float* weights;
};

/// target[p · target_step + c] = bias[c] + Σ_taps Σ_k source[p · source_step + k] · weights[k · out_channels + c]
struct ConvolutionRow {
  const ConvolutionTap* taps;
  int num_taps;
  int in_channels, out_channels, texels;
  ptrdiff_t source_step, target_step;
  const float* bias;
  float* target;
};
void ConvolveRow(const ConvolutionRow& row);

/// by_weights[k · out_channels + c] = Σ_rows Σ_texels source[k] · by_target[c], for `in_channels` k from the source's first.
struct ConvolutionProduct {
  const float* source;
  const float* by_target;
  int in_channels, out_channels, rows, texels;
  ptrdiff_t source_row, source_step, target_row, target_step;
  float* by_weights;
};
void SumProducts(const ConvolutionProduct& product);

}  // namespace bodyloom::motion_internal
