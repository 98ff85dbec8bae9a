// SPDX-License-Identifier: Apache-2.0
/// ONNX operators that multiply and add up, on oneDNN: convolutions and products of matrices.
#pragma once

#include <memory>
#include <vector>

#include "tracking/detection/inference/onnx_arithmetic.h"

namespace bodyloom {

/// A convolution of images of one shape: N×C×H×W with a kernel out × C/groups × height × width and, where there is one,
/// a bias. Its weights are kept in the order that the processor likes. Several threads may run it at once.
class OnnxConvolution {
 public:
  /// `swish`: x / (1 + exp(−x)) of the result. Throws std::runtime_error when image, kernel and bias do not fit.
  OnnxConvolution(const OnnxArguments& arguments, bool swish);
  ~OnnxConvolution();
  OnnxConvolution(OnnxConvolution&&) noexcept;
  OnnxConvolution& operator=(OnnxConvolution&&) noexcept;

  /// Throws std::runtime_error for an image of another shape than the one that it was made for.
  [[nodiscard]] OnnxTensor Run(const OnnxTensor& image) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// MatMul: products of the last two axes, the others broadcast; a list of numbers counts as one row or column.
OnnxTensor OnnxMatMul(const OnnxArguments& arguments);
/// Gemm: alpha · A · B + beta · C, A and B transposed on request.
OnnxTensor OnnxGemm(const OnnxArguments& arguments);

}  // namespace bodyloom
