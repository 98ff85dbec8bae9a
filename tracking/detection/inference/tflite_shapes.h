// SPDX-License-Identifier: Apache-2.0
/// TensorFlow Lite's operators as tflite_reader.cc reads them, and the shapes of their results.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

enum class TfliteKind {
  kAdd,
  kConcatenation,
  kConv2d,
  kDepthwiseConv2d,
  kDepthToSpace,
  kFullyConnected,
  kLogistic,
  kMaxPool2d,
  kMean,
  kPad,
  kPrelu,
  kReshape,
  kResizeBilinear,
  kStridedSlice
};

struct TfliteOperator {
  TfliteKind kind = TfliteKind::kAdd;
  std::vector<int> inputs;  ///< indices of tensors, without a bias that is left out
  int output = 0;           ///< index of a tensor
  bool relu6 = false;       ///< clamp the result to [0, 6]
  bool same_padding = false;
  int stride_h = 1, stride_w = 1;
  int filter_h = 1, filter_w = 1;  ///< of a kernel or of MAX_POOL_2D
  int axis = 0;                    ///< of CONCATENATION, from 0
  int block_size = 1;              ///< of DEPTH_TO_SPACE
  bool keeps_axes = false;         ///< of MEAN: axes that are averaged stay with length 1
};

/// Zeros around the rows or the columns of an image.
struct TflitePads {
  int before = 0, after = 0;
};

/// TensorFlow's SAME: total = max((⌈size / stride⌉ − 1)·stride + kernel − size, 0), the smaller half before. Uneven
/// when the total is odd: a 3×3 kernel of stride 2 on an even size has 0 before and 1 after.
TflitePads SamePads(int size, int kernel, int stride);

/// Shape of the operator's result. Its inputs' shapes and the int32 constants must be set. Throws std::runtime_error
/// "place: what was found, expected what" when the inputs do not fit each other.
std::vector<int64_t> TfliteOutputShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place);

}  // namespace bodyloom
