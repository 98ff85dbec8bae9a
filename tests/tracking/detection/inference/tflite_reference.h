// SPDX-License-Identifier: Apache-2.0
/// Reference implementation of the operators of graphs with channels-last images: plain loops with sums in double.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// An image with zero padding.
class ReferenceImage {
 public:
  ReferenceImage(const std::vector<int64_t>& shape, std::vector<float>* values)
      : h(static_cast<int>(shape[1])), w(static_cast<int>(shape[2])), c(static_cast<int>(shape[3])), values_(values) {
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

/// Values of all tensors; those of constants are empty.
inline std::vector<std::vector<float>> RunReference(const OperatorGraph& graph, const std::vector<float>& input) {
  std::vector<std::vector<float>> values(graph.tensors.size());
  values[static_cast<size_t>(graph.inputs[0])] = input;
  for (const GraphNode& node : graph.nodes) {
    const auto tensor = [&](size_t i) -> const OperatorGraph::Tensor& {
      return graph.tensors[static_cast<size_t>(node.inputs[i])];
    };
    const auto operand = [&](size_t i) -> std::vector<float>& { return values[static_cast<size_t>(node.inputs[i])]; };
    const auto numbers = [&](const char* name, const std::vector<int64_t>& absent) {
      const std::vector<int64_t> found = node.Integers(name, absent);
      return std::vector<int>(found.begin(), found.end());
    };
    const OperatorGraph::Tensor& target = graph.tensors[static_cast<size_t>(node.outputs[0])];
    std::vector<float>& out = values[static_cast<size_t>(node.outputs[0])];
    if (node.op == "Add") {
      for (size_t i = 0; i < operand(0).size(); ++i) out.push_back(operand(0)[i] + operand(1)[i]);
    } else if (node.op == "Clip") {
      for (const float x : operand(0)) out.push_back(std::clamp(x, node.Float("min", -1), node.Float("max", -1)));
    } else if (node.op == "Sigmoid") {
      for (const float x : operand(0)) out.push_back(static_cast<float>(1 / (1 + std::exp(-static_cast<double>(x)))));
    } else if (node.op == "Reshape") {
      out = operand(0);
    } else if (node.op == "PRelu") {  // slopes of the last axis
      const SharedNumbers<float>& slopes = tensor(1).constant.floats;
      for (size_t i = 0; i < operand(0).size(); ++i) {
        const float x = operand(0)[i];
        out.push_back(x < 0 ? slopes[i % slopes.size()] * x : x);
      }
    } else if (node.op == "Gemm") {  // rows · weightsᵀ + bias
      const auto columns = static_cast<size_t>(tensor(1).shape[1]), results = static_cast<size_t>(tensor(1).shape[0]);
      for (size_t row = 0; row < operand(0).size() / columns; ++row) {
        for (size_t to = 0; to < results; ++to) {
          double sum = node.inputs.size() > 2 ? tensor(2).constant.floats[to] : 0;
          for (size_t i = 0; i < columns; ++i) {
            sum += double{operand(0)[row * columns + i]} * tensor(1).constant.floats[to * columns + i];
          }
          out.push_back(static_cast<float>(sum));
        }
      }
    } else if (node.op == "ReduceMean" || node.op == "Slice") {
      // Places of the input, axis by axis: each adds to the result's place that lacks the averaged axes, or is cut
      // away.
      const bool slice = node.op == "Slice";
      const std::vector<int> axes = numbers("axes", {}), starts = numbers("starts", {}), ends = numbers("ends", {});
      const std::vector<int64_t>& shape = tensor(0).shape;
      std::vector<double> sums(slice ? 0 : GraphShapeSize(target.shape), 0.0);
      const double count =
          static_cast<double>(operand(0).size()) / static_cast<double>(std::max<size_t>(1, sums.size()));
      for (size_t i = 0; i < operand(0).size(); ++i) {
        size_t rest = i, block = operand(0).size(), place = 0;
        bool inside = true;
        for (size_t axis = 0; axis < shape.size(); ++axis) {
          block /= static_cast<size_t>(shape[axis]);
          const size_t at = rest / block;
          rest %= block;
          if (slice) {
            inside = inside && at >= static_cast<size_t>(starts[axis]) && at < static_cast<size_t>(ends[axis]);
          } else if (std::find(axes.begin(), axes.end(), static_cast<int>(axis)) == axes.end()) {
            place = place * static_cast<size_t>(shape[axis]) + at;
          }
        }
        if (slice && inside) out.push_back(operand(0)[i]);
        if (!slice) sums[place] += operand(0)[i] / count;
      }
      if (!slice) out.assign(sums.begin(), sums.end());
    } else if (node.op == "Concat") {  // blocks of what lies behind the axis, input by input
      size_t before = 1;
      for (int i = 0; i < numbers("axis", {})[0]; ++i) before *= static_cast<size_t>(target.shape[size_t(i)]);
      for (size_t b = 0; b < before; ++b) {
        for (size_t i = 0; i < node.inputs.size(); ++i) {
          const size_t block = operand(i).size() / before;
          for (size_t j = 0; j < block; ++j) out.push_back(operand(i)[b * block + j]);
        }
      }
    } else {
      const ReferenceImage in(tensor(0).shape, &operand(0));
      ReferenceImage to(target.shape, &out);
      const std::vector<int> strides = numbers("strides", {1, 1}), pads = numbers("pads", {0, 0, 0, 0});
      const bool depthwise = node.Has("group");
      to.Fill([&](int y, int x, int k) -> double {
        const int top = y * strides[0] - pads[0], left = x * strides[1] - pads[1];
        double sum = 0, largest = -1e30;
        if (node.op == "Conv") {
          const std::vector<int64_t>& side = tensor(1).shape;
          for (int i = 0; i < side[1]; ++i) {
            for (int j = 0; j < side[2]; ++j) {
              for (int l = depthwise ? k : 0; l < (depthwise ? k + 1 : in.c); ++l) {
                const int64_t place = (((depthwise ? 0 : k) * side[1] + i) * side[2] + j) * in.c + l;
                sum += in.At(top + i, left + j, l) * tensor(1).constant.floats[static_cast<size_t>(place)];
              }
            }
          }
          return sum + (node.inputs.size() > 2 ? tensor(2).constant.floats[static_cast<size_t>(k)] : 0);
        }
        if (node.op == "MaxPool") {
          const std::vector<int> side = numbers("kernel_shape", {});
          for (int i = 0; i < side[0]; ++i) {
            for (int j = 0; j < side[1]; ++j) largest = std::max(largest, in.At(top + i, left + j, k));
          }
          return largest;
        }
        if (node.op == "Pad") {
          const int l = k - pads[3];
          return l < 0 || l >= in.c ? 0 : in.At(y - pads[1], x - pads[2], l);
        }
        if (node.op == "DepthToSpace") {
          const int b = numbers("blocksize", {})[0];
          return in.At(y / b, x / b, ((y % b) * b + x % b) * to.c + k);
        }
        if (node.op != "Resize") throw std::logic_error(node.op + " has no reference");
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
      });
    }
  }
  return values;
}

}  // namespace bodyloom
