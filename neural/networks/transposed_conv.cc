// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/networks/transposed_conv.h"

#include <array>
#include <vector>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

using torch::Tensor;
using torch::indexing::Slice;

/// Rows (or columns) of the kernel that outputs of one parity see, for inputs from `first` (relative to half the
/// output's place) upwards.
struct Taps {
  int first = 0;
  std::vector<int64_t> kernel;
};

Taps TapsOf(int parity, int kernel, int padding) {
  Taps taps;
  // o = 2i − p + k: the larger k, the smaller i.
  for (int k = kernel - 1; k >= 0; --k) {
    if ((parity + padding - k) % 2 != 0) continue;
    if (taps.kernel.empty()) taps.first = (parity + padding - k) / 2;
    taps.kernel.push_back(k);
  }
  return taps;
}

}  // namespace

Tensor TransposedConv(const Tensor& x, const Tensor& weight, const Tensor& bias, int padding, int output_padding) {
  const auto kernel = static_cast<int>(weight.size(2));
  BODYLOOM_CHECK(
      padding == 1 && kernel + output_padding == 4 && (kernel == 4 || kernel == 3) && weight.size(3) == kernel,
      "transposed convolution: kernel ", kernel, ", padding ", padding, ", output padding ", output_padding);
  if (!x.device().is_cpu()) return torch::conv_transpose2d(x, weight, bias, 2, padding, output_padding);
  const int64_t batch = x.size(0), height = x.size(2), width = x.size(3);
  const Tensor by_output = weight.transpose(0, 1);
  const Tensor padded = torch::constant_pad_nd(x, {1, 1, 1, 1});
  std::array<Taps, 2> taps = {TapsOf(0, kernel, padding), TapsOf(1, kernel, padding)};
  const auto share = [](const Tensor& all, int64_t dimension, const Taps& of) {
    // Every other row, backwards.
    std::vector<Tensor> rows;
    for (const int64_t k : of.kernel) rows.push_back(all.select(dimension, k));
    return torch::stack(rows, dimension);
  };
  const auto reach = [](int64_t size, const Taps& of) {
    const auto begin = int64_t{1} + of.first;
    return Slice(begin, begin + size + static_cast<int64_t>(of.kernel.size()) - 1);
  };
  std::vector<Tensor> parities;
  for (const Taps& rows : taps) {
    const Tensor kernel_rows = share(by_output, 2, rows);
    for (const Taps& columns : taps) {
      const Tensor seen = padded.index({Slice(), Slice(), reach(height, rows), reach(width, columns)});
      parities.push_back(torch::conv2d(seen, share(kernel_rows, 3, columns), bias));
    }
  }
  const Tensor stacked = torch::stack(parities, 2);  // B × oc × 4 × H × W
  return torch::pixel_shuffle(stacked.reshape({batch, 4 * stacked.size(1), height, width}), 2);
}

}  // namespace bodyloom
