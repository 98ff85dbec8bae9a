// SPDX-License-Identifier: Apache-2.0
/// Transposed convolution of stride 2 that doubles an image's sides, as four ordinary convolutions. Internal: includes
/// LibTorch.
///
/// With padding p, output pixel o takes kernel row k of input pixel i where o = 2i − p + k: even and odd output rows
/// see different rows of the kernel, so each of the four parities of (row, column) is an ordinary convolution with its
/// share of the kernel, and the result is the four interleaved. Same sums, same number of multiply–adds; but
/// LibTorch 1.13 has no fast transposed convolution for the CPU, and multiplies matrices with whatever BLAS there is.
/// Forwards and backwards it is 1.7 to 4.4 times as fast this way (docs/networks.md).
#pragma once

#include <torch/torch.h>

namespace bodyloom {

/// What torch::conv_transpose2d with stride 2 makes of B×ic×H×W: weight is ic×oc×k×k, bias oc or undefined. Kernel 4
/// with padding 1, or kernel 3 with padding 1 and output padding 1, so that the result is B×oc×2H×2W; throws
/// std::invalid_argument for others. Not on the CPU it is that function itself.
torch::Tensor TransposedConv(const torch::Tensor& x, const torch::Tensor& weight, const torch::Tensor& bias,
                             int padding, int output_padding);

}  // namespace bodyloom
