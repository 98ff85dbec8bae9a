// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/uv_convolution.h"

#include <algorithm>
#include <array>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/render/avatar/motion/convolution_simd.h"

namespace bodyloom {
namespace {

using motion_internal::ConvolutionProduct;
using motion_internal::ConvolutionTap;
using motion_internal::ConvolveRow;
using motion_internal::kConvolutionChannels;
using motion_internal::kConvolutionTexels;
using motion_internal::SumProducts;

constexpr int kMostTaps = 9;

void CheckConvolution(const UvConvolution& c, size_t num_parameters, int in_channels, int out_side) {
  BODYLOOM_CHECK((c.size == 1 || c.size == 3) && (c.stride == 1 || (c.stride == 2 && c.size == 3)),
                 "convolution: kernels of ", c.size, " with stride ", c.stride, ", expected 1 or 3, and 1 or 2");
  BODYLOOM_CHECK(c.in_channels > 0 && c.in_channels % kConvolutionChannels == 0 && c.out_channels > 0 &&
                     c.out_channels % kConvolutionChannels == 0,
                 "convolution: ", c.in_channels, " to ", c.out_channels, " channels, expected multiples of ",
                 kConvolutionChannels);
  BODYLOOM_CHECK(num_parameters == static_cast<size_t>(c.num_parameters()), "convolution: ", num_parameters,
                 " parameters, expected ", c.num_parameters());
  BODYLOOM_CHECK(in_channels == c.in_channels, "convolution: a map of ", in_channels, " channels, expected ",
                 c.in_channels);
  BODYLOOM_CHECK(out_side > 0 && out_side % kConvolutionTexels == 0, "convolution: ", out_side,
                 " texels a side, expected a multiple of ", kConvolutionTexels);
}

/// Weights as the way back wants them: (i, j, c, k) for k from `first` on.
void Transpose(const UvConvolution& c, std::span<const float> parameters, int first, std::vector<float>* transposed) {
  const int count = c.in_channels - first;
  transposed->resize(static_cast<size_t>(c.size) * c.size * c.out_channels * count);
  float* to = transposed->data();
  for (int tap = 0; tap < c.size * c.size; ++tap) {
    const float* weights = parameters.data() + static_cast<size_t>(tap) * c.in_channels * c.out_channels;
    for (int out = 0; out < c.out_channels; ++out) {
      for (int in = first; in < c.in_channels; ++in) *to++ = weights[in * c.out_channels + out];
    }
  }
}

}  // namespace

void Convolve(const UvConvolution& c, std::span<const float> parameters, const TexelFeatures& in, int num_threads,
              TexelFeatures* out) {
  CheckConvolution(c, parameters.size(), in.channels(), in.side() / c.stride);
  out->Resize(in.side() / c.stride, c.out_channels);
  const int half = c.size / 2;
  ParallelFor(out->side(), num_threads, [&](int y) {
    std::array<ConvolutionTap, kMostTaps> taps;
    int n = 0;
    for (int i = 0; i < c.size; ++i) {
      for (int j = 0; j < c.size; ++j, ++n) {
        taps[n] = {in.at(c.stride * y + i - half, j - half),
                   parameters.data() + static_cast<size_t>(n) * c.in_channels * c.out_channels};
      }
    }
    ConvolveRow({.taps = taps.data(),
                 .num_taps = n,
                 .in_channels = c.in_channels,
                 .out_channels = c.out_channels,
                 .texels = out->side(),
                 .source_step = static_cast<ptrdiff_t>(c.stride) * c.in_channels,
                 .target_step = c.out_channels,
                 .bias = parameters.data() + c.num_weights(),
                 .target = out->at(y, 0)});
  });
}

void ConvolveByParameters(const UvConvolution& c, const TexelFeatures& in, const TexelFeatures& by_out, int num_threads,
                          std::span<float> by_parameters) {
  CheckConvolution(c, by_parameters.size(), in.channels(), by_out.side());
  BODYLOOM_CHECK(by_out.channels() == c.out_channels && by_out.side() * c.stride == in.side(),
                 "convolution: derivatives of ", by_out.side(), " texels and ", by_out.channels(), " channels");
  const int half = c.size / 2, blocks = c.in_channels / kConvolutionChannels;
  ParallelFor(c.size * c.size * blocks, num_threads, [&](int job) {
    const int tap = job / blocks, first = job % blocks * kConvolutionChannels;
    ConvolutionProduct product{};
    product.source = in.at(tap / c.size - half, tap % c.size - half) + first;
    product.by_target = by_out.at(0, 0);
    product.in_channels = kConvolutionChannels, product.out_channels = c.out_channels;
    product.rows = product.texels = by_out.side();
    product.source_row = c.stride * in.row_stride();
    product.source_step = static_cast<ptrdiff_t>(c.stride) * c.in_channels;
    product.target_row = by_out.row_stride(), product.target_step = c.out_channels;
    product.by_weights = by_parameters.data() + (static_cast<size_t>(tap) * c.in_channels + first) * c.out_channels;
    SumProducts(product);
  });
  float* by_bias = by_parameters.data() + c.num_weights();
  std::fill_n(by_bias, c.out_channels, 0.0F);
  for (int y = 0; y < by_out.side(); ++y) {
    for (int x = 0; x < by_out.side(); ++x) {
      for (int k = 0; k < c.out_channels; ++k) by_bias[k] += by_out.at(y, x)[k];
    }
  }
}

void ConvolveByInput(const UvConvolution& c, std::span<const float> parameters, const TexelFeatures& by_out,
                     int first_channel, int num_threads, std::vector<float>* scratch, TexelFeatures* by_in) {
  CheckConvolution(c, parameters.size(), c.in_channels, by_out.side());
  BODYLOOM_CHECK(by_out.channels() == c.out_channels, "convolution: derivatives of ", by_out.channels(),
                 " channels, expected ", c.out_channels);
  BODYLOOM_CHECK(first_channel >= 0 && first_channel < c.in_channels && first_channel % kConvolutionChannels == 0,
                 "convolution: derivatives from channel ", first_channel, " on, expected a multiple of ",
                 kConvolutionChannels, " below ", c.in_channels);
  const int count = c.in_channels - first_channel, half = c.size / 2;
  Transpose(c, parameters, first_channel, scratch);
  scratch->resize(scratch->size() + count, 0);  // no bias
  by_in->Resize(by_out.side() * c.stride, count);
  // A texel of the input reaches those of the output whose place t·y + i − half is its own: with stride 2, texels of even
  // and of odd rows and columns have taps of their own.
  ParallelFor(by_in->side(), num_threads, [&](int y) {
    for (int odd = 0; odd < c.stride; ++odd) {
      std::array<ConvolutionTap, kMostTaps> taps;
      int n = 0;
      for (int i = 0; i < c.size; ++i) {
        for (int j = 0; j < c.size; ++j) {
          const int from_y = y + half - i, from_x = odd + half - j;
          if (from_y % c.stride != 0 || from_x % c.stride != 0) continue;
          const int tap = i * c.size + j;
          taps[n++] = {by_out.at(from_y / c.stride, from_x / c.stride),
                       scratch->data() + static_cast<size_t>(tap) * c.out_channels * count};
        }
      }
      ConvolveRow({.taps = taps.data(),
                   .num_taps = n,
                   .in_channels = c.out_channels,
                   .out_channels = count,
                   .texels = by_out.side(),
                   .source_step = c.out_channels,
                   .target_step = static_cast<ptrdiff_t>(c.stride) * count,
                   .bias = scratch->data() + scratch->size() - count,
                   .target = by_in->at(y, odd)});
    }
  });
}

}  // namespace bodyloom
