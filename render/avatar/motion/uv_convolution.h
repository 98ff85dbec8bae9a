// SPDX-License-Identifier: Apache-2.0
/// Convolutions of maps over the UV atlas, and their derivatives, on the CPU without LibTorch.
///
/// With kernels of size s (1 or 3), stride t (1 or 2) and zeros around the map,
///   out(y, x, c) = b(c) + Σ_{i,j<s} Σ_k in(t y + i − ⌊s/2⌋, t x + j − ⌊s/2⌋, k) · w(i, j, k, c)
/// Parameters lie as w, row-major in (i, j, k, c), then b.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <span>
#include <vector>

#include "bodyloom/render/avatar/motion/texel_features.h"

namespace bodyloom {

/// Channels are multiples of 16.
struct UvConvolution {
  int in_channels = 16, out_channels = 16;
  int size = 3;
  int stride = 1;
  [[nodiscard]] int num_weights() const { return size * size * in_channels * out_channels; }
  [[nodiscard]] int num_parameters() const { return num_weights() + out_channels; }
};

/// `out` becomes in's side / stride, which must be a multiple of 8. All throw std::invalid_argument for sizes that do not
/// fit.
void Convolve(const UvConvolution& convolution, std::span<const float> parameters, const TexelFeatures& in,
              int num_threads, TexelFeatures* out);

/// From d loss / d out: by the parameters (set, not added to).
void ConvolveByParameters(const UvConvolution& convolution, const TexelFeatures& in, const TexelFeatures& by_out,
                          int num_threads, std::span<float> by_parameters);

/// … and by the input's channels from `first_channel` (a multiple of 16) on: by_in has those alone. `scratch` keeps its
/// memory between calls.
void ConvolveByInput(const UvConvolution& convolution, std::span<const float> parameters, const TexelFeatures& by_out,
                     int first_channel, int num_threads, std::vector<float>* scratch, TexelFeatures* by_in);

}  // namespace bodyloom
