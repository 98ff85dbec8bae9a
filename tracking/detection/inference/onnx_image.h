// SPDX-License-Identifier: Apache-2.0
/// ONNX operators on images, N×C×H×W, without weights that are multiplied: pools, enlargement, normalisation.
#pragma once

#include <array>

#include "tracking/detection/inference/onnx_arithmetic.h"

namespace bodyloom {

/// The attributes that windows have in common; the image has two axes of pixels.
struct OnnxWindow {
  std::array<int64_t, 2> kernel = {}, stride = {}, dilation = {}, before = {}, after = {};

  /// Kernel lengths come from the attribute `kernel_shape`, or are those given. Throws std::runtime_error for sides
  /// outside 1 to 64, strides outside 1 to 64, padding beyond the kernel.
  OnnxWindow(const OnnxArguments& arguments, std::array<int64_t, 2> kernel_lengths, std::array<int64_t, 2> image);
  /// How many windows fit an axis of that length.
  [[nodiscard]] int64_t Count(size_t axis, int64_t length, bool ceil = false) const;
};

/// Throws std::runtime_error unless input 0 is an image: four axes, floats.
const OnnxTensor& OnnxImage(const OnnxArguments& arguments);

OnnxTensor OnnxMaxPool(const OnnxArguments& arguments);
/// Mean of each channel.
OnnxTensor OnnxGlobalAveragePool(const OnnxArguments& arguments);
/// Resize and Upsample by whole factors, where each pixel becomes equal ones ("nearest").
OnnxTensor OnnxEnlarge(const OnnxArguments& arguments);
/// scale · (x − mean) / √(variance + epsilon) + bias, a channel.
OnnxTensor OnnxBatchNormalization(const OnnxArguments& arguments);

}  // namespace bodyloom
