// SPDX-License-Identifier: Apache-2.0
/// TensorFlow Lite's operators in plain loops over N×H×W×C, sums in double: what the network that runs is compared
/// with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "tracking/detection/inference/tflite_model.h"

namespace bodyloom {

/// An image that is 0 outside.
class ReferenceImage {
 public:
  ReferenceImage(const std::vector<int>& shape, std::vector<float>* values)
      : h(shape[1]), w(shape[2]), c(shape[3]), values_(values) {
    values_->resize(static_cast<size_t>(h) * static_cast<size_t>(w) * static_cast<size_t>(c));
  }
  [[nodiscard]] bool Holds(int y, int x) const { return y >= 0 && x >= 0 && y < h && x < w; }
  [[nodiscard]] double At(int y, int x, int k) const { return Holds(y, x) ? (*values_)[Place(y, x, k)] : 0; }
  void Set(int y, int x, int k, double value) { (*values_)[Place(y, x, k)] = static_cast<float>(value); }
  template <typename Function>
  void Fill(const Function& function) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        for (int k = 0; k < c; ++k) Set(y, x, k, function(y, x, k));
      }
    }
  }
  int h, w, c;

 private:
  [[nodiscard]] size_t Place(int y, int x, int k) const {
    const int place = (y * w + x) * c + k;
    return static_cast<size_t>(place);
  }
  std::vector<float>* values_;
};

/// The first row or column that the window of output 0 looks at. SAME: half of what is missing at the end goes before.
inline int ReferenceStart(int size, int kernel, int stride, bool same) {
  if (!same) return 0;
  const int last_begin = (static_cast<int>(std::ceil(static_cast<double>(size) / stride)) - 1) * stride;
  return -(std::max(0, last_begin + kernel - size) / 2);
}

/// Values of all tensors; those of constants are empty.
inline std::vector<std::vector<float>> RunReference(const TfliteModel& model, const std::vector<float>& input) {
  std::vector<std::vector<float>> values(model.tensors.size());
  values[static_cast<size_t>(model.inputs[0])] = input;
  for (const TfliteOperator& op : model.operators) {
    const auto tensor = [&](size_t i) -> const TfliteTensor& {
      return model.tensors[static_cast<size_t>(op.inputs[i])];
    };
    const auto operand = [&](size_t i) -> std::vector<float>& { return values[static_cast<size_t>(op.inputs[i])]; };
    const TfliteTensor& target = model.tensors[static_cast<size_t>(op.output)];
    std::vector<float>& out = values[static_cast<size_t>(op.output)];
    switch (op.kind) {
      case TfliteKind::kAdd:
        for (size_t i = 0; i < operand(0).size(); ++i) out.push_back(operand(0)[i] + operand(1)[i]);
        break;
      case TfliteKind::kLogistic:
        for (const float x : operand(0)) out.push_back(static_cast<float>(1 / (1 + std::exp(-static_cast<double>(x)))));
        break;
      case TfliteKind::kReshape:
        out = operand(0);
        break;
      case TfliteKind::kConcatenation: {  // blocks of what lies behind the axis, input by input
        size_t before = 1;
        for (int i = 0; i < op.axis; ++i) before *= static_cast<size_t>(target.shape[static_cast<size_t>(i)]);
        for (size_t b = 0; b < before; ++b) {
          for (size_t i = 0; i < op.inputs.size(); ++i) {
            const size_t block = operand(i).size() / before;
            for (size_t j = 0; j < block; ++j) out.push_back(operand(i)[b * block + j]);
          }
        }
        break;
      }
      default: {
        const ReferenceImage in(tensor(0).shape, &operand(0));
        ReferenceImage to(target.shape, &out);
        const int y0 = ReferenceStart(in.h, op.filter_h, op.stride_h, op.same_padding);
        const int x0 = ReferenceStart(in.w, op.filter_w, op.stride_w, op.same_padding);
        const bool depthwise = op.kind == TfliteKind::kDepthwiseConv2d;
        to.Fill([&](int y, int x, int k) -> double {
          const int top = y0 + y * op.stride_h, left = x0 + x * op.stride_w;
          double sum = 0, largest = -1e30;
          switch (op.kind) {
            case TfliteKind::kConv2d:
            case TfliteKind::kDepthwiseConv2d:
              for (int i = 0; i < op.filter_h; ++i) {
                for (int j = 0; j < op.filter_w; ++j) {
                  for (int l = depthwise ? k : 0; l < (depthwise ? k + 1 : in.c); ++l) {
                    const int place = (((depthwise ? 0 : k) * op.filter_h + i) * op.filter_w + j) * in.c + l;
                    sum += in.At(top + i, left + j, l) * tensor(1).values()[static_cast<size_t>(place)];
                  }
                }
              }
              return sum + (op.inputs.size() > 2 ? tensor(2).values()[static_cast<size_t>(k)] : 0);
            case TfliteKind::kMaxPool2d:
              for (int i = 0; i < op.filter_h; ++i) {
                for (int j = 0; j < op.filter_w; ++j) largest = std::max(largest, in.At(top + i, left + j, k));
              }
              return largest;
            case TfliteKind::kPad: {
              const std::vector<int32_t>& n = tensor(1).ints;
              const int l = k - n[6];
              return l < 0 || l >= in.c ? 0 : in.At(y - n[2], x - n[4], l);
            }
            case TfliteKind::kDepthToSpace: {
              const int b = op.block_size;
              return in.At(y / b, x / b, ((y % b) * b + x % b) * to.c + k);
            }
            case TfliteKind::kResizeBilinear: {
              const double v = (y + 0.5) * in.h / to.h - 0.5, u = (x + 0.5) * in.w / to.w - 0.5;
              for (int i = 0; i < 2; ++i) {
                for (int j = 0; j < 2; ++j) {
                  const double row = std::floor(v) + i, column = std::floor(u) + j;
                  const double weight = (1 - std::abs(v - row)) * (1 - std::abs(u - column));
                  sum += weight * in.At(std::clamp(static_cast<int>(row), 0, in.h - 1),
                                        std::clamp(static_cast<int>(column), 0, in.w - 1), k);
                }
              }
              return sum;
            }
            default:
              throw std::logic_error("an operator without a reference");
          }
        });
      }
    }
    if (op.relu6) {
      for (float& x : out) x = std::clamp(x, 0.0F, 6.0F);
    }
  }
  return values;
}

}  // namespace bodyloom
