// SPDX-License-Identifier: Apache-2.0
/// Runs a network of an ONNX file on the processor.
///
/// Operators: those that the usual exports of YOLOv8-pose, YOLO11-pose and RTMPose have, with operator sets 7 to 22:
/// onnx_arithmetic.h, onnx_rearrangement.h, onnx_image.h, onnx_products.h, and Identity and Dropout. Convolutions and
/// products of matrices run on oneDNN; what hangs on constants alone is computed once; x · sigmoid(x) behind a
/// convolution is done by it. Results agree with other runtimes' to rounding.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "tracking/detection/inference/onnx_model.h"

namespace bodyloom {

/// One object is used by one thread at a time, and runs on that thread alone. Copies share the weights; several in
/// several threads do not disturb each other. Equal inputs give equal bits.
class OnnxNetwork {
 public:
  /// For inputs of that shape, which is the model's but where that is dynamic (−1). Runs once, on zeros. Throws
  /// std::runtime_error "path: node 'name' (operator): what was found, expected what" for an operator that is not known
  /// or not in this use, std::invalid_argument for a shape that is not the model's.
  OnnxNetwork(OnnxModel model, std::vector<int64_t> input_shape);

  [[nodiscard]] const std::vector<int64_t>& input_shape() const;
  [[nodiscard]] const std::vector<std::vector<int64_t>>& output_shapes() const;

  /// The outputs in the file's order, all floats. `input` is in C order. Throws std::invalid_argument for another
  /// number.
  [[nodiscard]] std::vector<OnnxTensor> Run(std::vector<float> input) const;

 private:
  struct Program;
  std::shared_ptr<const Program> program_;
};

}  // namespace bodyloom
