// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_shapes.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

int CheckedInt(int64_t value, const std::string& place) {
  if (value < 1 || value > std::numeric_limits<int>::max()) {
    ThrowFileError(place, Concatenate("a side of ", value, ", expected 1 to ", std::numeric_limits<int>::max()));
  }
  return static_cast<int>(value);
}

const std::vector<int64_t>& ImageShape(const OperatorGraph::Tensor& tensor, const std::string& place) {
  if (tensor.shape.size() != 4 || tensor.shape[0] != 1) {
    ThrowFileError(place,
                   "an input of shape " + GraphShapeText(tensor.shape) + ", expected 1 x height x width x channels");
  }
  return tensor.shape;
}

/// Rows or columns left by a window.
int64_t WindowedSize(int64_t size, int window, int stride, bool same, const std::string& place) {
  if (same) return (size - 1) / stride + 1;
  if (window > size)
    ThrowFileError(place, Concatenate("a window of ", window, " on ", size, ", expected one that fits"));
  return (size - window) / stride + 1;
}

std::vector<int64_t> WindowedShape(const std::vector<int64_t>& in, const TfliteOperator& op, int64_t channels,
                                   const std::string& place) {
  return {1, WindowedSize(in[1], op.filter_h, op.stride_h, op.same_padding, place),
          WindowedSize(in[2], op.filter_w, op.stride_w, op.same_padding, place), channels};
}

std::vector<int64_t> ConvolvedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = ImageShape(graph.tensors[op.inputs[0]], place);
  const std::vector<int64_t>& kernel = graph.tensors[op.inputs[1]].shape;
  const bool depthwise = op.kind == TfliteKind::kDepthwiseConv2d;
  if (kernel.size() != 4 || kernel[3] != in[3] || (depthwise && kernel[0] != 1)) {
    ThrowFileError(place, Concatenate("a kernel of shape ", GraphShapeText(kernel), ", expected ",
                                      depthwise ? "1" : "out", " x height x width x ", in[3]));
  }
  const int64_t channels = depthwise ? in[3] : kernel[0];
  if (op.inputs.size() > 2 && graph.tensors[op.inputs[2]].shape != std::vector<int64_t>{channels}) {
    ThrowFileError(place, Concatenate("a bias of shape ", GraphShapeText(graph.tensors[op.inputs[2]].shape),
                                      ", expected ", channels));
  }
  return WindowedShape(in, op, channels, place);
}

std::vector<int64_t> PooledShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = ImageShape(graph.tensors[op.inputs[0]], place);
  if (op.same_padding) {
    const TflitePads rows = SamePads(static_cast<int>(in[1]), op.filter_h, op.stride_h),
                     columns = SamePads(static_cast<int>(in[2]), op.filter_w, op.stride_w);
    if (rows.before + rows.after + columns.before + columns.after > 0) {
      ThrowFileError(place, "padding SAME that pads, expected VALID");
    }
  }
  return WindowedShape(in, op, in[3], place);
}

std::vector<int64_t> ConcatenatedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  std::vector<int64_t> shape = graph.tensors[op.inputs[0]].shape;
  if (op.axis < 0 || op.axis >= static_cast<int>(shape.size())) {
    ThrowFileError(place, Concatenate("axis ", op.axis, ", expected 0 to ", shape.size() - 1));
  }
  int64_t along = shape[op.axis];
  for (size_t i = 1; i < op.inputs.size(); ++i) {
    std::vector<int64_t> other = graph.tensors[op.inputs[i]].shape;
    const bool same_rank = other.size() == shape.size();
    if (same_rank) {
      along += other[op.axis];
      other[op.axis] = shape[op.axis];
    }
    if (other != shape) {
      ThrowFileError(place, Concatenate("input ", i, " of shape ", GraphShapeText(graph.tensors[op.inputs[i]].shape),
                                        ", expected ", GraphShapeText(shape), " but for axis ", op.axis));
    }
  }
  shape[op.axis] = CheckedInt(along, place);
  return shape;
}

std::vector<int64_t> PaddedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  std::vector<int64_t> shape = ImageShape(graph.tensors[op.inputs[0]], place);
  const OperatorGraph::Tensor& pads = graph.tensors[op.inputs[1]];
  if (pads.shape != std::vector<int64_t>{4, 2}) {
    ThrowFileError(place, "paddings of shape " + GraphShapeText(pads.shape) + ", expected 4x2");
  }
  for (size_t i = 0; i < 8; ++i) {
    if (pads.constant.ints[i] < 0 || (i < 2 && pads.constant.ints[i] != 0)) {
      ThrowFileError(place, Concatenate("padding ", pads.constant.ints[i], " of axis ", i / 2, ", expected ",
                                        i < 2 ? "0" : "0 or more"));
    }
  }
  for (size_t i = 1; i < 4; ++i) {
    shape[i] = CheckedInt(int64_t{shape[i]} + pads.constant.ints[2 * i] + pads.constant.ints[2 * i + 1], place);
  }
  return shape;
}

/// As the file has it, −1 too.
std::string ListText(const std::vector<int64_t>& numbers) {
  std::string text;
  for (const int64_t n : numbers) text += (text.empty() ? "" : "x") + std::to_string(n);
  return text;
}

std::vector<int64_t> ReshapedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const OperatorGraph::Tensor& in = graph.tensors[op.inputs[0]];
  const std::vector<int64_t> wanted = graph.tensors[op.inputs[1]].constant.ints.Copy();
  std::vector<int64_t> shape = wanted;
  const auto size = static_cast<int64_t>(GraphShapeSize(in.shape));
  if (shape.empty() || shape.size() > 4)
    ThrowFileError(place, Concatenate("to ", shape.size(), " axes, expected 1 to 4"));
  int64_t known = 1;
  for (const int64_t n : shape) {
    if (n != -1 && (n < 1 || n > size))
      ThrowFileError(place, Concatenate("a side of ", n, ", expected -1 or 1 to ", size));
    if (n > 0) known *= n;
    if (known > size) break;
  }
  const auto open = std::find(shape.begin(), shape.end(), -1);
  if (open != shape.end() && known <= size && size % known == 0) *open = size / known;
  if (open == shape.end() ? known != size : *open < 1 || std::find(open + 1, shape.end(), -1) != shape.end()) {
    ThrowFileError(place, Concatenate("to ", ListText(wanted), ", expected ", size, " numbers"));
  }
  return shape;
}

std::vector<int64_t> ResizedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = ImageShape(graph.tensors[op.inputs[0]], place);
  const SharedNumbers<int64_t>& to = graph.tensors[op.inputs[1]].constant.ints;
  if (to.size() != 2)
    ThrowFileError(place, Concatenate("a size of ", to.size(), " numbers, expected height and width"));
  return {1, CheckedInt(to[0], place), CheckedInt(to[1], place), in[3]};
}

std::vector<int64_t> SpacedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = ImageShape(graph.tensors[op.inputs[0]], place);
  const int64_t block = op.block_size;
  if (block < 1 || block > in[3] || in[3] % (block * block) != 0) {
    ThrowFileError(place,
                   Concatenate("blocks of ", block, " of ", in[3], " channels, expected a square that divides them"));
  }
  return {1, CheckedInt(in[1] * block, place), CheckedInt(in[2] * block, place), in[3] / (block * block)};
}

std::vector<int64_t> ConnectedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = graph.tensors[op.inputs[0]].shape;
  const std::vector<int64_t>& weights = graph.tensors[op.inputs[1]].shape;
  if (in.size() != 2) ThrowFileError(place, "an input of shape " + GraphShapeText(in) + ", expected rows x columns");
  if (weights.size() != 2 || weights[1] != in[1]) {
    ThrowFileError(place, Concatenate("weights of shape ", GraphShapeText(weights), ", expected out x ", in[1]));
  }
  if (op.inputs.size() > 2 && graph.tensors[op.inputs[2]].shape != std::vector<int64_t>{weights[0]}) {
    ThrowFileError(place, Concatenate("a bias of shape ", GraphShapeText(graph.tensors[op.inputs[2]].shape),
                                      ", expected ", weights[0]));
  }
  return {in[0], weights[0]};
}

std::vector<int64_t> AveragedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = graph.tensors[op.inputs[0]].shape;
  std::vector<bool> averaged(in.size(), false);
  for (const int64_t axis : graph.tensors[op.inputs[1]].constant.ints) {
    if (axis < 0 || axis >= static_cast<int64_t>(in.size()) || averaged[static_cast<size_t>(axis)]) {
      ThrowFileError(place, Concatenate("axis ", axis, ", expected different ones of 0 to ", in.size() - 1));
    }
    averaged[static_cast<size_t>(axis)] = true;
  }
  std::vector<int64_t> shape;
  for (size_t i = 0; i < in.size(); ++i) {
    if (!averaged[i] || op.keeps_axes) shape.push_back(averaged[i] ? 1 : in[i]);
  }
  if (shape.empty()) ThrowFileError(place, "over all axes, expected one that stays");
  return shape;
}

std::vector<int64_t> LeakyShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = ImageShape(graph.tensors[op.inputs[0]], place);
  const std::vector<int64_t>& slopes = graph.tensors[op.inputs[1]].shape;
  if (slopes != std::vector<int64_t>{1, 1, in[3]}) {
    ThrowFileError(place, Concatenate("slopes of shape ", GraphShapeText(slopes), ", expected 1x1x", in[3]));
  }
  return in;
}

std::vector<int64_t> SlicedShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  std::vector<int64_t> shape = graph.tensors[op.inputs[0]].shape;
  const auto numbers = [&](size_t i) -> const SharedNumbers<int64_t>& {
    return graph.tensors[op.inputs[i]].constant.ints;
  };
  for (size_t i = 1; i < 4; ++i) {
    if (numbers(i).size() != shape.size()) {
      ThrowFileError(place,
                     Concatenate(numbers(i).size(), " numbers for ", shape.size(), " axes, expected one for each"));
    }
  }
  for (size_t axis = 0; axis < shape.size(); ++axis) {
    const int64_t begin = numbers(1)[axis], end = numbers(2)[axis], step = numbers(3)[axis];
    if (begin < 0 || end <= begin || end > shape[axis] || step != 1) {
      ThrowFileError(place, Concatenate("from ", begin, " to ", end, " by ", step, " of axis ", axis,
                                        ", expected a range within ", shape[axis], " by 1"));
    }
    shape[axis] = end - begin;
  }
  return shape;
}

}  // namespace

TflitePads SamePads(int size, int kernel, int stride) {
  const int total = std::max(((size - 1) / stride) * stride + kernel - size, 0);
  return {total / 2, total - total / 2};
}

std::vector<int64_t> TfliteOutputShape(const OperatorGraph& graph, const TfliteOperator& op, const std::string& place) {
  const std::vector<int64_t>& in = graph.tensors[op.inputs[0]].shape;
  switch (op.kind) {
    case TfliteKind::kAdd:
      if (graph.tensors[op.inputs[1]].shape != in) {
        ThrowFileError(place,
                       Concatenate(GraphShapeText(in), " and ", GraphShapeText(graph.tensors[op.inputs[1]].shape),
                                   ", expected equal shapes"));
      }
      return in;
    case TfliteKind::kLogistic:
      return in;
    case TfliteKind::kConcatenation:
      return ConcatenatedShape(graph, op, place);
    case TfliteKind::kConv2d:
    case TfliteKind::kDepthwiseConv2d:
      return ConvolvedShape(graph, op, place);
    case TfliteKind::kDepthToSpace:
      return SpacedShape(graph, op, place);
    case TfliteKind::kFullyConnected:
      return ConnectedShape(graph, op, place);
    case TfliteKind::kMaxPool2d:
      return PooledShape(graph, op, place);
    case TfliteKind::kMean:
      return AveragedShape(graph, op, place);
    case TfliteKind::kPad:
      return PaddedShape(graph, op, place);
    case TfliteKind::kPrelu:
      return LeakyShape(graph, op, place);
    case TfliteKind::kReshape:
      return ReshapedShape(graph, op, place);
    case TfliteKind::kResizeBilinear:
      return ResizedShape(graph, op, place);
    case TfliteKind::kStridedSlice:
      return SlicedShape(graph, op, place);
  }
  return {};
}

}  // namespace bodyloom
