// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/channels_last.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

namespace bodyloom {
namespace {

/// Axes of N×C×H×W in the order of N×H×W×C, and back.
const std::vector<int64_t> kToLast = {0, 2, 3, 1}, kToFirst = {0, 3, 1, 2};

/// For each axis of N×C×H×W, its place in N×H×W×C.
constexpr std::array<int64_t, 4> kAxisInLast = {0, 3, 1, 2};

const std::set<std::string> kUnary = {"Sigmoid", "HardSigmoid", "HardSwish", "Relu",  "LeakyRelu", "Tanh",    "Sqrt",
                                      "Exp",     "Abs",         "Neg",       "Floor", "Clip",      "Identity"};
const std::set<std::string> kBinary = {"Add", "Sub", "Mul", "Div", "Pow", "Max", "Min", "PRelu"};

template <typename T>
std::vector<T> Permuted(const T* values, const std::vector<int64_t>& order) {
  std::vector<T> permuted;
  for (const int64_t i : order) permuted.push_back(values[i]);
  return permuted;
}

/// Numbers for the four axes, from those of N×C×H×W to those of N×H×W×C; tensors of one axis.
GraphTensor PermutedList(const GraphTensor& list) {
  if (list.has_floats()) return {{4}, Permuted(list.floats.data(), kToLast)};
  return {{4}, Permuted(list.ints.data(), kToLast)};
}

/// A constant that is broadcast to images: with four axes, the channels last. One number stays as it is.
std::optional<GraphTensor> BroadcastLast(const GraphTensor& constant) {
  if (constant.size() == 1 && constant.rank() <= 4) return GraphTensor(constant.Reshaped({}));
  if (constant.rank() > 4 || !constant.has_floats()) return std::nullopt;
  std::vector<int64_t> shape(4 - constant.shape.size(), 1);
  shape.insert(shape.end(), constant.shape.begin(), constant.shape.end());
  const auto channels = size_t(shape[1]), pixels = size_t(shape[2] * shape[3]);
  std::vector<float> values(constant.size());
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t n = i / (channels * pixels), c = i / pixels % channels, pixel = i % pixels;
    values[(n * pixels + pixel) * channels + c] = constant.floats[i];
  }
  return GraphTensor(Permuted(shape.data(), kToLast), std::move(values));
}

/// The graph with the tensors of its Constant nodes among the constants.
OperatorGraph WithConstants(OperatorGraph graph) {
  std::erase_if(graph.nodes, [&graph](const GraphNode& node) {
    const auto value = node.attributes.find("value");
    if (node.op != "Constant" || value == node.attributes.end() || !value->second.tensor.has_numbers() ||
        node.outputs.size() != 1 || node.outputs[0] < 0) {
      return false;
    }
    OperatorGraph::Tensor& tensor = graph.tensors[size_t(node.outputs[0])];
    tensor.shape = value->second.tensor.shape;
    tensor.constant = value->second.tensor;
    return true;
  });
  return graph;
}

class Rewriter {
 public:
  explicit Rewriter(OperatorGraph graph)
      : from_(WithConstants(std::move(graph))), to_(from_), writer_(from_.tensors.size(), nullptr) {
    for (const GraphNode& node : from_.nodes) {
      for (const int output : node.outputs) {
        if (output >= 0) writer_[size_t(output)] = &node;
      }
    }
  }

  [[nodiscard]] bool IsPossible() const {
    const auto is_convolution = [](const GraphNode& node) { return node.op == "Conv"; };
    return std::any_of(from_.nodes.begin(), from_.nodes.end(), is_convolution) &&
           std::all_of(from_.nodes.begin(), from_.nodes.end(), [this](const GraphNode& node) { return Fits(node); });
  }

  OperatorGraph Rewrite() {
    to_.channels_last = true;
    to_.nodes.clear();
    is_last_.assign(to_.tensors.size(), false);
    other_.assign(to_.tensors.size(), -1);
    for (const GraphNode& node : from_.nodes) Add(node);
    for (int& output : to_.outputs) output = First(output, "output");
    return std::move(to_);
  }

 private:
  [[nodiscard]] const GraphTensor& ConstantOf(int tensor) const { return to_.tensors[size_t(tensor)].constant; }
  [[nodiscard]] bool IsConstant(int tensor) const { return ConstantOf(tensor).has_numbers(); }
  [[nodiscard]] bool IsLast(int tensor) const { return tensor >= 0 && is_last_[size_t(tensor)]; }

  /// Of weights, also behind a cast.
  [[nodiscard]] std::vector<int64_t> ShapeOf(int tensor) const {
    while (tensor >= 0 && !from_.tensors[size_t(tensor)].constant.has_numbers()) {
      const GraphNode* node = writer_[size_t(tensor)];
      if (node == nullptr) return {};
      if ((node->op != "Cast" && node->op != "Identity") || node->inputs.empty()) return {};
      tensor = node->inputs[0];
    }
    return tensor < 0 ? std::vector<int64_t>() : from_.tensors[size_t(tensor)].constant.shape;
  }

  [[nodiscard]] bool Fits(const GraphNode& node) const {
    if (node.op == "DepthToSpace") return false;
    if (node.op == "Conv") {
      const std::vector<int64_t> shape = node.inputs.size() < 2 ? std::vector<int64_t>() : ShapeOf(node.inputs[1]);
      return shape.size() == 4 && node.inputs[0] >= 0 && (node.Integer("group", 1) == 1 || shape[1] == 1);
    }
    if (node.op != "Resize" && node.op != "Upsample") return true;
    if (node.Text("mode", "nearest") != "nearest" || node.inputs.empty() || node.inputs[0] < 0) return false;
    for (size_t i = 1; i < node.inputs.size(); ++i) {
      if (node.inputs[i] >= 0 && !from_.tensors[size_t(node.inputs[i])].constant.has_numbers()) return false;
    }
    return true;
  }

  int NewTensor(GraphTensor constant = {}, bool is_last = false) {
    OperatorGraph::Tensor& tensor = to_.tensors.emplace_back();
    tensor.shape = constant.shape;
    tensor.constant = std::move(constant);
    is_last_.push_back(is_last);
    other_.push_back(-1);
    return int(to_.tensors.size()) - 1;
  }

  int Transposed(int tensor, const std::vector<int64_t>& order, const std::string& name) {
    const int result = NewTensor();
    GraphNode& node = to_.nodes.emplace_back();
    node.name = name;
    node.op = "Transpose";
    node.inputs = {tensor};
    node.outputs = {result};
    node.attributes["perm"] = GraphAttribute::Ints(order);
    return result;
  }

  /// The same image in the other order; transposed once.
  int Other(int tensor, const std::string& name) {
    if (other_[size_t(tensor)] < 0) {
      const bool was_last = IsLast(tensor);
      const int result = Transposed(tensor, was_last ? kToFirst : kToLast, name);
      is_last_[size_t(result)] = !was_last;
      other_[size_t(result)] = tensor;
      other_[size_t(tensor)] = result;
    }
    return other_[size_t(tensor)];
  }
  int First(int tensor, const std::string& name) { return IsLast(tensor) ? Other(tensor, name) : tensor; }
  int Last(int tensor, const std::string& name) { return IsLast(tensor) ? tensor : Other(tensor, name); }

  void Keep(GraphNode node, bool is_last) {
    for (const int output : node.outputs) {
      if (output >= 0) is_last_[size_t(output)] = is_last;
    }
    to_.nodes.push_back(std::move(node));
  }

  void Add(GraphNode node) {
    const bool has_image = !node.inputs.empty() && node.inputs[0] >= 0;
    if (has_image && (node.op == "Conv" || node.op == "MaxPool" || node.op == "Resize" || node.op == "Upsample" ||
                      node.op == "GlobalAveragePool" || node.op == "BatchNormalization")) {
      AddImageOperator(std::move(node));
    } else if (kUnary.contains(node.op) && has_image && IsLast(node.inputs[0])) {
      Keep(std::move(node), true);
    } else if (!AddBroadcast(node) && !AddAlongAxis(node) && !AddPad(node) && !AddShape(node)) {
      for (int& input : node.inputs) {
        if (input >= 0) input = First(input, node.name);
      }
      Keep(std::move(node), false);
    }
  }

  void AddImageOperator(GraphNode node) {
    node.inputs[0] = Last(node.inputs[0], node.name);
    if (node.op == "Conv") {
      // out × in × rows × columns; 1 × rows × columns × channels with a group a channel.
      const bool by_channel = node.Integer("group", 1) > 1;
      node.inputs[1] = Transposed(node.inputs[1], by_channel ? std::vector<int64_t>{1, 2, 3, 0} : kToLast, node.name);
    } else if (node.op == "Resize" || node.op == "Upsample") {
      for (size_t i = 1; i < node.inputs.size(); ++i) {
        const int list = node.inputs[i];
        if (list >= 0 && ConstantOf(list).shape == std::vector<int64_t>{4}) {
          node.inputs[i] = NewTensor(PermutedList(ConstantOf(list)));
        }
      }
      const auto scales = node.attributes.find("scales");
      if (scales != node.attributes.end() && scales->second.floats.size() == 4) {
        scales->second.floats = Permuted(scales->second.floats.data(), kToLast);
      }
    }
    Keep(std::move(node), true);
  }

  /// Sums, products and the like of images and constants.
  bool AddBroadcast(const GraphNode& node) {
    if (!kBinary.contains(node.op) || node.inputs.size() != 2) return false;
    GraphNode changed = node;
    bool any = false;
    for (int& input : changed.inputs) {
      if (input < 0) return false;
      any = any || IsLast(input);
      if (IsLast(input)) continue;
      if (!IsConstant(input)) return false;
      std::optional<GraphTensor> constant = BroadcastLast(ConstantOf(input));
      if (!constant) return false;
      input = NewTensor(std::move(*constant));
    }
    if (!any) return false;
    Keep(std::move(changed), true);
    return true;
  }

  /// Concat, Split, and means that keep their axes.
  bool AddAlongAxis(GraphNode& node) {
    const bool is_mean = node.op == "ReduceMean" || node.op == "ReduceSum" || node.op == "ReduceMax";
    if (node.op != "Concat" && node.op != "Split" && !is_mean) return false;
    const size_t images = node.op == "Concat" ? node.inputs.size() : 1;
    if (node.inputs.size() < images || images == 0 ||
        !std::all_of(node.inputs.begin(), node.inputs.begin() + std::ptrdiff_t(images),
                     [this](int input) { return IsLast(input); })) {
      return false;
    }
    if (is_mean && (!node.Has("axes") || node.Integer("keepdims", 1) != 1)) return false;
    const std::string key = is_mean ? "axes" : "axis";
    std::vector<int64_t> axes = node.Integers(key, {0});
    for (int64_t& axis : axes) {
      if (axis < -4 || axis > 3) return false;
      axis = kAxisInLast[size_t(axis < 0 ? axis + 4 : axis)];
    }
    node.attributes[key] = GraphAttribute::Ints(axes);
    Keep(std::move(node), true);
    return true;
  }

  bool AddPad(GraphNode& node) {
    if (node.op != "Pad" || node.inputs.empty() || !IsLast(node.inputs[0])) return false;
    const bool is_input = node.inputs.size() > 1 && node.inputs[1] >= 0 && IsConstant(node.inputs[1]);
    if (!is_input && !node.Has("pads")) return false;
    const std::vector<int64_t> pads = is_input ? ConstantOf(node.inputs[1]).ints.Copy() : node.Integers("pads", {});
    if (pads.size() != 8 || (node.inputs.size() > 3 && node.inputs[3] >= 0)) return false;
    std::vector<int64_t> permuted = Permuted(pads.data(), kToLast), after = Permuted(pads.data() + 4, kToLast);
    permuted.insert(permuted.end(), after.begin(), after.end());
    if (is_input) {
      node.inputs[1] = NewTensor(GraphTensor({8}, std::move(permuted)));
    } else {
      node.attributes["pads"] = GraphAttribute::Ints(std::move(permuted));
    }
    Keep(std::move(node), true);
    return true;
  }

  /// The shape of an image, without transposing it.
  bool AddShape(GraphNode& node) {
    if (node.op != "Shape" || node.inputs.size() != 1 || !IsLast(node.inputs[0]) || node.outputs.size() != 1 ||
        node.Has("start") || node.Has("end")) {
      return false;
    }
    GraphNode gather;
    gather.name = node.name;
    gather.op = "Gather";
    gather.outputs = node.outputs;
    node.outputs = {NewTensor()};
    gather.inputs = {node.outputs[0], NewTensor(GraphTensor({4}, kToFirst))};
    Keep(std::move(node), false);
    Keep(std::move(gather), false);
    return true;
  }

  OperatorGraph from_, to_;
  std::vector<const GraphNode*> writer_;  ///< of each tensor of the graph
  std::vector<bool> is_last_;             ///< of each tensor of the result: an image whose channels are last
  std::vector<int> other_;                ///< the same image in the other order; −1: none yet
};

}  // namespace

OperatorGraph WithChannelsLast(const OperatorGraph& graph) {
  if (graph.channels_last) return graph;
  Rewriter rewriter(graph);
  return rewriter.IsPossible() ? rewriter.Rewrite() : graph;
}

}  // namespace bodyloom
