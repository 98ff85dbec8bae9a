// SPDX-License-Identifier: Apache-2.0
/// What the motion of the body's surface does to a person of Gaussians: a small convolutional network from maps over the UV
/// atlas (normals and velocities, data_tools/descriptors/person_frames.h) to a map of changes of place, size, opacity
/// and colour, looked up at each Gaussian's place on the surface (motion_offsets.h). Source of the idea: Yoon et al.,
/// "Learning Motion-Dependent Appearance for High-Fidelity Rendering of Dynamic Humans from a Single Camera", CVPR 2022,
/// E_Δ of eq. 4 and 5, with Gaussians in the place of its decoders.
///
/// With S the maps' side, in: their channels, 1 where the atlas shows the body, and learned channels that tell texels
/// apart, up to a multiple of 16. C = width, all kernels 3×3 with ReLU but the last:
///   a = conv/2(in)  S/2     b = conv(a)
///   c = conv/2(b)   S/4     d = conv(c)
///   e = conv/2(d)   S/8     f = conv(e)     g = ReLU(W · mean of f + w), one vector for the body
///   h = conv(up(f + g) + d)  S/4     i = conv(up(h) + b)  S/2     j = conv(up(i))  S, 16 channels     out = 1×1(j)
/// `up` repeats every texel 2×2. The last layer begins as zero, so a new network changes nothing.
///
/// A person's past is in the maps, not in a state of the network: a state would have to be run up to every frame that is
/// learned from, and frames could not be drawn at random, nor a single one be shown.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodyloom/render/avatar/motion/uv_convolution.h"
#include "bodyloom/render/splat/float_columns.h"

namespace bodyloom {

struct MotionNetworkOptions {
  int side = 64;      ///< of the maps, texels: a multiple of 64
  int maps = 42;      ///< channels that are given, 1 to 256
  int embedding = 5;  ///< channels a texel that are learned, 1 to 64
  int width = 32;     ///< C, a multiple of 16, at most 256
  int outputs = 20;   ///< channels that are wanted, 1 to 64
  bool operator==(const MotionNetworkOptions&) const = default;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

class MotionNetwork {
 public:
  /// `shows_body`: side², not 0 where the atlas has something to show. Throws std::invalid_argument when options are not
  /// valid or sizes do not fit.
  MotionNetwork(const MotionNetworkOptions& options, std::vector<uint8_t> shows_body);

  [[nodiscard]] const MotionNetworkOptions& options() const { return options_; }
  [[nodiscard]] int num_parameters() const { return num_parameters_; }
  /// Fresh parameters, one column: He's normal weights (He et al., ICCV 2015, eq. 10), embeddings of standard deviation
  /// 1, zeros in the last layer and in biases.
  [[nodiscard]] FloatColumns Initial(uint64_t seed) const;

  /// `maps`: maps × side × side, planes. The answer has `outputs` channels and spare ones up to a multiple of 16, and
  /// stays until the next call. Throws std::invalid_argument for other sizes.
  const TexelFeatures& Forward(const FloatColumns& parameters, std::span<const float> maps, int num_threads);

  /// Of the last Forward, with its parameters: d loss / d parameters (set) from d loss / d out, spare channels zero.
  void Backward(const FloatColumns& parameters, const TexelFeatures& by_out, int num_threads,
                FloatColumns* by_parameters);

 private:
  enum Layer { kA, kB, kC, kD, kE, kF, kH, kI, kJ, kOut, kNumLayers };
  [[nodiscard]] std::span<const float> Of(const FloatColumns& parameters, Layer layer) const;
  void Run(Layer layer, const FloatColumns& parameters, const TexelFeatures& in, int num_threads);
  /// Derivatives by a layer's parameters, and by its input from `first_channel` on into by_in (null: not wanted).
  void GoBack(Layer layer, const FloatColumns& parameters, const TexelFeatures& in, int first_channel, int num_threads,
              FloatColumns* by_parameters, TexelFeatures* by_in);

  MotionNetworkOptions options_;
  std::vector<uint8_t> shows_body_;
  int in_channels_ = 0;  ///< of layer a
  std::array<UvConvolution, kNumLayers> layers_;
  std::array<int, kNumLayers> first_parameter_{};
  int dense_ = 0, embedding_ = 0;  ///< where theirs begin
  int num_parameters_ = 0;
  TexelFeatures in_, to_h_, to_i_, to_j_;
  std::array<TexelFeatures, kNumLayers> out_, by_out_, by_in_;
  std::vector<float> mean_, body_, by_body_, by_mean_, scratch_;
};

}  // namespace bodyloom
