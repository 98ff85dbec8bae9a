// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/motion/convolution_simd.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bodyloom/render/avatar/motion/convolution_simd.cc"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bodyloom::motion_internal::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DC = hn::CappedTag<float, kConvolutionChannels>;
using VC = hn::Vec<DC>;

// Sixteen channels are one register of AVX-512, two of AVX2, four of SSE. As many sums at once as hide an addition's
// latency and still fit into the registers.
constexpr int kVectors = kConvolutionChannels / static_cast<int>(hn::MaxLanes(DC()));
constexpr int kAtOnce = kVectors >= 4 ? 2 : kVectors == 2 ? 4 : 8;
static_assert(kConvolutionTexels % kAtOnce == 0);

void ConvolveRow(const ConvolutionRow& row) {
  const DC d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(DC()));
  for (int c = 0; c < row.out_channels; c += kConvolutionChannels) {
    for (int p = 0; p < row.texels; p += kAtOnce) {
      VC sums[kAtOnce][kVectors];
      for (int v = 0; v < kVectors; ++v) {
        const VC bias = hn::LoadU(d, row.bias + c + v * kLanes);
        for (int i = 0; i < kAtOnce; ++i) sums[i][v] = bias;
      }
      for (int t = 0; t < row.num_taps; ++t) {
        const float* source = row.taps[t].source + p * row.source_step;
        const float* weights = row.taps[t].weights + c;
        for (int k = 0; k < row.in_channels; ++k, weights += row.out_channels) {
          VC w[kVectors];
          for (int v = 0; v < kVectors; ++v) w[v] = hn::LoadU(d, weights + v * kLanes);
          for (int i = 0; i < kAtOnce; ++i) {
            const VC x = hn::Set(d, source[i * row.source_step + k]);
            for (int v = 0; v < kVectors; ++v) sums[i][v] = hn::Add(sums[i][v], hn::Mul(x, w[v]));
          }
        }
      }
      for (int i = 0; i < kAtOnce; ++i) {
        for (int v = 0; v < kVectors; ++v) {
          hn::StoreU(sums[i][v], d, row.target + (p + i) * row.target_step + c + v * kLanes);
        }
      }
    }
  }
}

void SumProducts(const ConvolutionProduct& job) {
  const DC d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(DC()));
  for (int c = 0; c < job.out_channels; c += kConvolutionChannels) {
    for (int k = 0; k < job.in_channels; k += kAtOnce) {
      VC sums[kAtOnce][kVectors];
      for (int i = 0; i < kAtOnce; ++i) {
        for (int v = 0; v < kVectors; ++v) sums[i][v] = hn::Zero(d);
      }
      for (int y = 0; y < job.rows; ++y) {
        const float* source = job.source + y * job.source_row + k;
        const float* target = job.by_target + y * job.target_row + c;
        for (int x = 0; x < job.texels; ++x, source += job.source_step, target += job.target_step) {
          VC g[kVectors];
          for (int v = 0; v < kVectors; ++v) g[v] = hn::LoadU(d, target + v * kLanes);
          for (int i = 0; i < kAtOnce; ++i) {
            const VC s = hn::Set(d, source[i]);
            for (int v = 0; v < kVectors; ++v) sums[i][v] = hn::Add(sums[i][v], hn::Mul(s, g[v]));
          }
        }
      }
      for (int i = 0; i < kAtOnce; ++i) {
        for (int v = 0; v < kVectors; ++v) {
          hn::StoreU(sums[i][v], d, job.by_weights + static_cast<ptrdiff_t>(k + i) * job.out_channels + c + v * kLanes);
        }
      }
    }
  }
}

}  // namespace bodyloom::motion_internal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bodyloom::motion_internal {

HWY_EXPORT(ConvolveRow);
HWY_EXPORT(SumProducts);

void ConvolveRow(const ConvolutionRow& row) { HWY_DYNAMIC_DISPATCH(ConvolveRow)(row); }
void SumProducts(const ConvolutionProduct& product) { HWY_DYNAMIC_DISPATCH(SumProducts)(product); }

}  // namespace bodyloom::motion_internal
#endif  // HWY_ONCE
