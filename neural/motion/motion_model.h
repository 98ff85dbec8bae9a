// SPDX-License-Identifier: Apache-2.0
/// The networks of the motion-dependent renderer. Internal: includes LibTorch.
///
///   f_3D  = E_Δ(N_t, V_t … V_{t−9})                       in UV, d channels
///   f̂_t   = Π f_3D                                        at the pixels that see the body, 0 elsewhere
///   ŝ_t   = softmax D_s(f̂_t, ŝ_{t−1})                     classes of every pixel, class 0 the background
///   a, n  = D_a(f̂_t, ŝ_t, Â_{t−1}, n̂_{t−1})
///   Â_t   = (1 − ŝ_t[0]) · sigmoid a,   n̂_t = (1 − ŝ_t[0]) · tanh n / |tanh n|
/// Source: Yoon et al., "Learning Motion-Dependent Appearance for High-Fidelity Rendering of Dynamic Humans from a
/// Single Camera", CVPR 2022, Section 3; channels and levels: neural/motion/motion_config.h.
///
/// With the descriptor dense2d the input of E is dense UV coordinates and keypoints of ten frames in the image's plane,
/// and f̂ is its output at every pixel, on the body and off it.
/// With `surface` (not in the paper) f̂ has the rendered UV coordinates (u, v, 1) beside Π f_3D; with `texture` (not in
/// the paper) also Π of a learned texture. Without shape there is no ŝ: Â = sigmoid a must learn the person's outline.
/// Without motion f̂ is the rendered UV itself, (u, v, 1) on the body and 0 elsewhere, and the learned texture. Without
/// normals n̂ is left out.
#pragma once

#include <torch/torch.h>
#include <vector>

#include "neural/motion/motion_config.h"
#include "neural/networks/unet.h"

namespace bodyloom {

// A learned texture, the motion-independent appearance of a person: values per texel, trained with the networks.
//
//   x = gain · Π T          C channels at the pixels that see the body, 0 elsewhere
//   A x, B x                logits of classes and colour, to which those of the networks are added
// Source of T: Thies, Zollhöfer, Nießner, "Deferred Neural Rendering", SIGGRAPH 2019; A and B are this project's.

struct LearnedTextureImpl : torch::nn::Module {
  /// `num_labels` 0: no A. T is initialised with zeros.
  LearnedTextureImpl(int size, int features, int num_labels);

  /// Computes x from B×2×h×w coordinates and B×1×h×w body.
  torch::Tensor forward(const torch::Tensor& uv, const torch::Tensor& body);

  torch::Tensor values;                                                  ///< T: 1×C×S×S
  torch::nn::Conv2d colour_of_texel{nullptr}, labels_of_texel{nullptr};  ///< B, A
};
TORCH_MODULE(LearnedTexture);

/// Input of B frames: B×channels×U×U (dense2d: B×channels×h×w), B×2×h×w, B×1×h×w.
struct MotionInput {
  torch::Tensor motion, uv, body;
};

/// Recurrent state from one frame to the next. Parts that the configuration leaves out are undefined.
struct MotionState {
  torch::Tensor labels;                               ///< B×K×h×w probabilities
  torch::Tensor image;                                ///< B×3×h×w
  torch::Tensor normals;                              ///< B×3×h×w
  [[nodiscard]] std::vector<torch::Tensor*> Parts();  ///< those that are defined
};

struct MotionStepResult {
  MotionState state;
  torch::Tensor label_logits;  ///< B×K×h×w, undefined without shape
  torch::Tensor foreground;    ///< B×1×h×w, 1 without shape
  torch::Tensor colour;        ///< B×3×h×w, sigmoid a, not multiplied by the foreground
};

struct MotionModelImpl : torch::nn::Module {
  explicit MotionModelImpl(const MotionConfig& config);

  /// Computes f_3D from B×channels×U×U; for dense2d the features at every pixel.
  torch::Tensor Encode(const torch::Tensor& motion);
  /// Computes f̂ from f_3D (ignored, and may be undefined, without motion).
  torch::Tensor Project(const torch::Tensor& descriptor, const torch::Tensor& uv, const torch::Tensor& body);
  MotionStepResult Decode(const torch::Tensor& projected, const MotionState& before);
  MotionStepResult forward(const MotionInput& input, const MotionState& before);
  /// The past of a clip's first frame: zeros.
  [[nodiscard]] MotionState InitialState(int64_t batch, int64_t height, int64_t width) const;

  MotionConfig config;
  UNet encoder{nullptr}, shape_decoder{nullptr}, appearance_decoder{nullptr};
  LearnedTexture texture{nullptr};
};
TORCH_MODULE(MotionModel);

}  // namespace bodyloom
