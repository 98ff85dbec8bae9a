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
    Refuse(place, Concatenate("a side of ", value, ", expected 1 to ", std::numeric_limits<int>::max()));
  }
  return static_cast<int>(value);
}

const std::vector<int>& ImageShape(const TfliteTensor& tensor, const std::string& place) {
  if (tensor.shape.size() != 4 || tensor.shape[0] != 1) {
    Refuse(place, "an input of shape " + TfliteShapeText(tensor.shape) + ", expected 1 x height x width x channels");
  }
  return tensor.shape;
}

/// Rows or columns left by a window.
int WindowedSize(int size, int window, int stride, bool same, const std::string& place) {
  if (same) return (size - 1) / stride + 1;
  if (window > size) Refuse(place, Concatenate("a window of ", window, " on ", size, ", expected one that fits"));
  return (size - window) / stride + 1;
}

std::vector<int> WindowedShape(const std::vector<int>& in, const TfliteOperator& op, int channels,
                               const std::string& place) {
  return {1, WindowedSize(in[1], op.filter_h, op.stride_h, op.same_padding, place),
          WindowedSize(in[2], op.filter_w, op.stride_w, op.same_padding, place), channels};
}

std::vector<int> ConvolvedShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  const std::vector<int>& in = ImageShape(model.tensors[op.inputs[0]], place);
  const std::vector<int>& kernel = model.tensors[op.inputs[1]].shape;
  const bool depthwise = op.kind == TfliteKind::kDepthwiseConv2d;
  if (kernel.size() != 4 || kernel[3] != in[3] || (depthwise && kernel[0] != 1)) {
    Refuse(place, Concatenate("a kernel of shape ", TfliteShapeText(kernel), ", expected ", depthwise ? "1" : "out",
                              " x height x width x ", in[3]));
  }
  const int channels = depthwise ? in[3] : kernel[0];
  if (op.inputs.size() > 2 && model.tensors[op.inputs[2]].shape != std::vector<int>{channels}) {
    Refuse(place, Concatenate("a bias of shape ", TfliteShapeText(model.tensors[op.inputs[2]].shape), ", expected ",
                              channels));
  }
  return WindowedShape(in, op, channels, place);
}

std::vector<int> PooledShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  const std::vector<int>& in = ImageShape(model.tensors[op.inputs[0]], place);
  if (op.same_padding) {
    const TflitePads rows = SamePads(in[1], op.filter_h, op.stride_h),
                     columns = SamePads(in[2], op.filter_w, op.stride_w);
    if (rows.before + rows.after + columns.before + columns.after > 0) {
      Refuse(place, "padding SAME that pads, expected VALID");
    }
  }
  return WindowedShape(in, op, in[3], place);
}

std::vector<int> ConcatenatedShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  std::vector<int> shape = model.tensors[op.inputs[0]].shape;
  if (op.axis < 0 || op.axis >= static_cast<int>(shape.size())) {
    Refuse(place, Concatenate("axis ", op.axis, ", expected 0 to ", shape.size() - 1));
  }
  int64_t along = shape[op.axis];
  for (size_t i = 1; i < op.inputs.size(); ++i) {
    std::vector<int> other = model.tensors[op.inputs[i]].shape;
    const bool same_rank = other.size() == shape.size();
    if (same_rank) {
      along += other[op.axis];
      other[op.axis] = shape[op.axis];
    }
    if (other != shape) {
      Refuse(place, Concatenate("input ", i, " of shape ", TfliteShapeText(model.tensors[op.inputs[i]].shape),
                                ", expected ", TfliteShapeText(shape), " but for axis ", op.axis));
    }
  }
  shape[op.axis] = CheckedInt(along, place);
  return shape;
}

std::vector<int> PaddedShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  std::vector<int> shape = ImageShape(model.tensors[op.inputs[0]], place);
  const TfliteTensor& pads = model.tensors[op.inputs[1]];
  if (pads.shape != std::vector<int>{4, 2}) {
    Refuse(place, "paddings of shape " + TfliteShapeText(pads.shape) + ", expected 4x2");
  }
  for (size_t i = 0; i < 8; ++i) {
    if (pads.ints[i] < 0 || (i < 2 && pads.ints[i] != 0)) {
      Refuse(place,
             Concatenate("padding ", pads.ints[i], " of axis ", i / 2, ", expected ", i < 2 ? "0" : "0 or more"));
    }
  }
  for (size_t i = 1; i < 4; ++i) {
    shape[i] = CheckedInt(int64_t{shape[i]} + pads.ints[2 * i] + pads.ints[2 * i + 1], place);
  }
  return shape;
}

std::vector<int> ReshapedShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  const TfliteTensor& in = model.tensors[op.inputs[0]];
  std::vector<int> shape = model.tensors[op.inputs[1]].ints;
  const auto size = static_cast<int64_t>(in.size());
  if (shape.empty() || shape.size() > 4) Refuse(place, Concatenate("to ", shape.size(), " axes, expected 1 to 4"));
  int64_t known = 1;
  for (const int n : shape) {
    if (n != -1 && (n < 1 || n > size)) Refuse(place, Concatenate("a side of ", n, ", expected -1 or 1 to ", size));
    if (n > 0) known *= n;
    if (known > size) break;
  }
  const auto open = std::find(shape.begin(), shape.end(), -1);
  if (open != shape.end() && known <= size && size % known == 0) *open = static_cast<int>(size / known);
  if (open == shape.end() ? known != size : *open < 1 || std::find(open + 1, shape.end(), -1) != shape.end()) {
    Refuse(place,
           Concatenate("to ", TfliteShapeText(model.tensors[op.inputs[1]].ints), ", expected ", size, " numbers"));
  }
  return shape;
}

std::vector<int> ResizedShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  const std::vector<int>& in = ImageShape(model.tensors[op.inputs[0]], place);
  const std::vector<int32_t>& to = model.tensors[op.inputs[1]].ints;
  if (to.size() != 2) Refuse(place, Concatenate("a size of ", to.size(), " numbers, expected height and width"));
  return {1, CheckedInt(to[0], place), CheckedInt(to[1], place), in[3]};
}

std::vector<int> SpacedShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  const std::vector<int>& in = ImageShape(model.tensors[op.inputs[0]], place);
  const int64_t block = op.block_size;
  if (block < 1 || block > in[3] || in[3] % (block * block) != 0) {
    Refuse(place, Concatenate("blocks of ", block, " of ", in[3], " channels, expected a square that divides them"));
  }
  return {1, CheckedInt(in[1] * block, place), CheckedInt(in[2] * block, place),
          static_cast<int>(in[3] / (block * block))};
}

}  // namespace

TflitePads SamePads(int size, int kernel, int stride) {
  const int total = std::max(((size - 1) / stride) * stride + kernel - size, 0);
  return {total / 2, total - total / 2};
}

std::vector<int> TfliteOutputShape(const TfliteModel& model, const TfliteOperator& op, const std::string& place) {
  const std::vector<int>& in = model.tensors[op.inputs[0]].shape;
  switch (op.kind) {
    case TfliteKind::kAdd:
      if (model.tensors[op.inputs[1]].shape != in) {
        Refuse(place, Concatenate(TfliteShapeText(in), " and ", TfliteShapeText(model.tensors[op.inputs[1]].shape),
                                  ", expected equal shapes"));
      }
      return in;
    case TfliteKind::kLogistic:
      return in;
    case TfliteKind::kConcatenation:
      return ConcatenatedShape(model, op, place);
    case TfliteKind::kConv2d:
    case TfliteKind::kDepthwiseConv2d:
      return ConvolvedShape(model, op, place);
    case TfliteKind::kDepthToSpace:
      return SpacedShape(model, op, place);
    case TfliteKind::kMaxPool2d:
      return PooledShape(model, op, place);
    case TfliteKind::kPad:
      return PaddedShape(model, op, place);
    case TfliteKind::kReshape:
      return ReshapedShape(model, op, place);
    case TfliteKind::kResizeBilinear:
      return ResizedShape(model, op, place);
  }
  return {};
}

bool IsTfliteImage(const std::vector<int>& shape) { return shape.size() == 4; }

size_t NumTfliteValues(const std::vector<int>& shape) {
  size_t product = 1;
  for (const int n : shape) product *= size_t(n);
  return product;
}

std::string TfliteShapeText(const std::vector<int>& shape) {
  std::string text;
  for (const int n : shape) text += (text.empty() ? "" : "x") + std::to_string(n);
  return text.empty() ? "(none)" : text;
}

}  // namespace bodyloom
