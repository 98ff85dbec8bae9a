// SPDX-License-Identifier: Apache-2.0
/// The two building blocks of the motion-dependent renderer's networks. Internal: includes LibTorch.
///
/// Conv(ic, oc, kernel, stride, padding), Deconv likewise; LReLU has slope 0.2, IN is instance normalisation without
/// learned scale and shift (epsilon 1e-5):
///   C-BLK(ic, oc)     = Conv(ic, oc, 3, 1, 1) LReLU+IN, Conv(oc, oc, 3, 1, 1) LReLU+IN, Conv(oc, oc, 4, 2, 1) LReLU+IN
///   D-BLK(ic, mc, oc) = Conv(ic, mc, 3, 1, 1) LReLU+IN, Conv(mc, mc, 3, 1, 1) LReLU+IN, Conv(mc, mc, 3, 1, 1)
///                       LReLU+IN, Deconv(mc, oc, 4, 2, 1) LReLU
/// C-BLK halves an image's sides, D-BLK doubles them. Source: Yoon et al., "Learning Motion-Dependent Appearance for
/// High-Fidelity Rendering of Dynamic Humans from a Single Camera", CVPR 2022, Fig. 11, which leaves the order inside
/// "LReLU+IN" open.
///
/// Convolutions directly followed by a normalisation, which would remove their bias, have none (norm first). Weights
/// are initialised as N(0, 2 / (1.04 fan_in)) (Kaiming for the slope 0.2; fan_in of a Deconv with stride 2: mc·4·4/4),
/// biases at 0.
#pragma once

#include <torch/torch.h>

namespace bodyloom {

enum class NormOrder { kNormFirst, kActivationFirst };

constexpr double kLeakySlope = 0.2;

/// LReLU, in place: x must be the fresh output of a convolution or norm that is not used elsewhere.
torch::Tensor LeakyRelu(torch::Tensor x);

/// IN: normalises each channel of each image to mean 0 and variance 1 (+ 1e-5).
torch::Tensor InstanceNorm(const torch::Tensor& x);

/// IN then LReLU, or LReLU then IN. May work in place, as above.
torch::Tensor NormAndActivation(const torch::Tensor& x, NormOrder order);

/// IN then ReLU.
torch::Tensor NormAndRelu(const torch::Tensor& x);

/// A square convolution with Kaiming weights (fan_in, slope 0.2) and a bias of zero, or none.
torch::nn::Conv2d MakeConv(int from, int to, int kernel, int stride, int padding, bool bias);

/// B×ic×H×W → B×oc×H/2×W/2; H and W even and at least 4.
struct ConvBlockImpl : torch::nn::Module {
  ConvBlockImpl(int ic, int oc, NormOrder norm_order = NormOrder::kNormFirst);
  torch::Tensor forward(torch::Tensor x);

  NormOrder order;
  torch::nn::Conv2d conv1{nullptr}, conv2{nullptr}, down{nullptr};
};
TORCH_MODULE(ConvBlock);

/// B×ic×H×W → B×oc×2H×2W; H·W at least 2.
struct DeconvBlockImpl : torch::nn::Module {
  DeconvBlockImpl(int ic, int mc, int oc, NormOrder norm_order = NormOrder::kNormFirst);
  torch::Tensor forward(torch::Tensor x);

  NormOrder order;
  torch::nn::Conv2d conv1{nullptr}, conv2{nullptr}, conv3{nullptr};
  torch::nn::ConvTranspose2d up{nullptr};
};
TORCH_MODULE(DeconvBlock);

// Transposed convolution of stride 2 that doubles an image's sides, as four ordinary convolutions.
//
// With padding p, output pixel o uses kernel row k of input pixel i where o = 2i − p + k: even and odd output rows use
// different rows of the kernel, so each of the four parities of (row, column) is an ordinary convolution with its part
// of the kernel, and the result is the four interleaved. The sums and multiply–adds are the same, but LibTorch 1.13 has
// no fast transposed convolution for the CPU and uses general matrix products of the installed BLAS. This way both
// passes are about twice as fast (forward: docs/lab/motion_renderer.md, "Speed").

/// Equivalent to torch::conv_transpose2d with stride 2 for B×ic×H×W: weight is ic×oc×k×k, bias oc or undefined. Kernel
/// 4 with padding 1, or kernel 3 with padding 1 and output padding 1, so that the result is B×oc×2H×2W; throws
/// std::invalid_argument for others. On other devices than the CPU it calls that function.
torch::Tensor TransposedConv(const torch::Tensor& x, const torch::Tensor& weight, const torch::Tensor& bias,
                             int padding, int output_padding);

}  // namespace bodyloom
