// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/onnx_reader.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <queue>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"
#include "tracking/detection/inference/protobuf.h"

namespace bodyloom {
namespace {

constexpr size_t kMaxBytes = size_t{1} << 30, kMaxNodes = 20'000, kMaxAttributes = 100, kMaxAxes = 8;
constexpr size_t kMaxUnpacked = 16;  // bytes of constants a byte of the file
enum OnnxType : int64_t { kOnnxFloat = 1, kOnnxInt32 = 6, kOnnxInt64 = 7, kOnnxBool = 9, kOnnxHalf = 10 };

/// Contents of a tensor's message.
struct StoredTensor {
  std::string_view name, raw;
  std::vector<int64_t> shape, ints;
  std::vector<float> floats;
  int64_t type = 0;
  bool has_raw = false;
};

template <typename Stored, typename To>
std::vector<To> Unpacked(std::string_view raw, To (*convert)(Stored)) {
  std::vector<To> values(raw.size() / sizeof(Stored));
  for (size_t i = 0; i < values.size(); ++i) {
    Stored stored;
    std::memcpy(&stored, raw.data() + i * sizeof(Stored), sizeof(Stored));
    values[i] = convert(stored);
  }
  return values;
}

class OnnxReader {
 public:
  OnnxReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), budget_(kMaxUnpacked * bytes.size()) {
    graph_.name = name;
  }

  OperatorGraph Read() {
    ProtoMessage model(bytes_, name_ + ": not an ONNX file");
    std::string_view graph;
    bool has_graph = false;
    for (ProtoField field; model.Next(&field);) {
      if (field.number == 7) graph = model.Bytes(field), has_graph = true;
      if (field.number == 8) ReadOperatorSet(model.Bytes(field));
    }
    if (!has_graph) ThrowFileError(name_, "not an ONNX file", "no graph in it");
    if (graph_.opset < 7)
      ThrowFileError(name_, "operators", Concatenate("version ", graph_.opset, ", expected 7 or later"));
    ReadGraph(graph);
    return std::move(graph_);
  }

 private:
  [[nodiscard]] ProtoMessage Message(std::string_view bytes, const std::string& place) const {
    return {bytes, name_ + ": " + place};
  }

  void ReadOperatorSet(std::string_view bytes) {
    ProtoMessage set = Message(bytes, "operator set");
    bool standard = true;
    int64_t version = 0;
    for (ProtoField field; set.Next(&field);) {
      if (field.number == 1) standard = IsStandard(set.Bytes(field));
      if (field.number == 2) version = set.Integer(field);
    }
    if (standard) graph_.opset = version;
  }

  static bool IsStandard(std::string_view domain) { return domain.empty() || domain == "ai.onnx"; }

  void ReadGraph(std::string_view bytes) {
    ProtoMessage graph = Message(bytes, "graph");
    std::vector<std::string_view> nodes, inputs, outputs;
    for (ProtoField field; graph.Next(&field);) {
      if (field.number == 1) nodes.push_back(graph.Bytes(field));
      if (field.number == 5) AddConstant(graph.Bytes(field));
      if (field.number == 11) inputs.push_back(graph.Bytes(field));
      if (field.number == 12) outputs.push_back(graph.Bytes(field));
      if (field.number == 15) ThrowFileError(name_, "graph", "sparse constants, expected dense ones");
    }
    if (nodes.size() > kMaxNodes)
      ThrowFileError(name_, "graph", Concatenate(nodes.size(), " nodes, expected at most ", kMaxNodes));
    ReadInputs(inputs);
    for (const size_t i : OrderOf(nodes)) ReadNode(nodes[i], Concatenate("node ", i));
    for (const std::string_view output : outputs) graph_.outputs.push_back(Known(Value(output).first, "outputs"));
    if (graph_.outputs.empty()) ThrowFileError(name_, "graph", "no outputs");
  }

  /// The nodes so that each follows those whose results it takes, otherwise as in the file.
  [[nodiscard]] std::vector<size_t> OrderOf(const std::vector<std::string_view>& nodes) const {
    std::map<std::string_view, size_t> writer;
    std::vector<std::vector<std::string_view>> inputs(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
      ProtoMessage node = Message(nodes[i], Concatenate("node ", i));
      for (ProtoField field; node.Next(&field);) {
        if (field.number == 1) inputs[i].push_back(node.Bytes(field));
        if (field.number == 2) writer.emplace(node.Bytes(field), i);
      }
    }
    std::vector<std::vector<size_t>> readers(nodes.size());
    std::vector<size_t> awaited(nodes.size(), 0);
    for (size_t i = 0; i < nodes.size(); ++i) {
      for (const std::string_view input : inputs[i]) {
        const auto from = writer.find(input);
        if (input.empty() || from == writer.end()) continue;
        readers[from->second].push_back(i);
        ++awaited[i];
      }
    }
    std::priority_queue<size_t, std::vector<size_t>, std::greater<>> ready;
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (awaited[i] == 0) ready.push(i);
    }
    std::vector<size_t> order;
    while (!ready.empty()) {
      order.push_back(ready.top());
      ready.pop();
      for (const size_t reader : readers[order.back()]) {
        if (--awaited[reader] == 0) ready.push(reader);
      }
    }
    if (order.size() < nodes.size()) {
      const auto left = std::find_if(awaited.begin(), awaited.end(), [](size_t count) { return count > 0; });
      ThrowFileError(name_, Concatenate("node ", left - awaited.begin()),
                     "nodes that take each other's results in a circle, expected an order in which they can run");
    }
    return order;
  }

  void ReadInputs(const std::vector<std::string_view>& inputs) {
    for (const std::string_view input : inputs) {
      auto [name, shape] = Value(input);
      if (number_.contains(name)) continue;  // a constant, as files before version 4 list them
      graph_.inputs.push_back(Define(name, "inputs"));
      graph_.tensors.back().shape = std::move(shape);
    }
    if (graph_.inputs.size() != 1)
      ThrowFileError(name_, "inputs", Concatenate(graph_.inputs.size(), " of them, expected one image"));
  }

  /// Name and shape.
  [[nodiscard]] std::pair<std::string, std::vector<int64_t>> Value(std::string_view bytes) const {
    ProtoMessage value = Message(bytes, "value");
    std::pair<std::string, std::vector<int64_t>> result;
    for (ProtoField field; value.Next(&field);) {
      if (field.number == 1) result.first = value.Bytes(field);
      if (field.number == 2) result.second = ShapeOfType(value.Bytes(field));
    }
    return result;
  }

  [[nodiscard]] std::vector<int64_t> ShapeOfType(std::string_view bytes) const {
    std::vector<int64_t> shape;
    ProtoMessage type = Message(bytes, "type");
    for (ProtoField field; type.Next(&field);) {
      if (field.number != 1) continue;
      ProtoMessage tensor = Message(type.Bytes(field), "type");
      for (ProtoField part; tensor.Next(&part);) {
        if (part.number != 2) continue;
        ProtoMessage axes = Message(tensor.Bytes(part), "shape");
        for (ProtoField axis; axes.Next(&axis);) {
          if (axis.number == 1) shape.push_back(LengthOf(axes.Bytes(axis)));
        }
      }
    }
    if (shape.size() > kMaxAxes)
      ThrowFileError(name_, "shape", Concatenate(shape.size(), " axes, expected at most ", kMaxAxes));
    return shape;
  }

  [[nodiscard]] int64_t LengthOf(std::string_view bytes) const {
    int64_t length = -1;
    ProtoMessage axis = Message(bytes, "shape");
    for (ProtoField field; axis.Next(&field);) {
      if (field.number == 1) length = axis.Integer(field);
    }
    return length > 0 ? length : -1;
  }

  int Define(const std::string& name, const std::string& place) {
    const auto [at, is_new] = number_.emplace(name, int(number_.size()));
    if (!is_new) ThrowFileError(name_, place, "'" + PrintableText(name) + "' is written twice");
    graph_.tensors.push_back({PrintableText(name), {}, {}});
    return at->second;
  }

  [[nodiscard]] int Known(const std::string& name, const std::string& place) const {
    const auto at = number_.find(name);
    if (at == number_.end()) {
      ThrowFileError(name_, place,
                     "'" + PrintableText(name) + "' is not there, expected a constant or what another node writes");
    }
    return at->second;
  }

  void ReadNode(std::string_view bytes, std::string place) {
    ProtoMessage message = Message(bytes, place);
    GraphNode& node = graph_.nodes.emplace_back();
    std::vector<std::string> inputs, outputs;
    std::vector<std::string_view> attributes;
    bool standard = true;
    for (ProtoField field; message.Next(&field);) {
      if (field.number == 1) inputs.emplace_back(message.Bytes(field));
      if (field.number == 2) outputs.emplace_back(message.Bytes(field));
      if (field.number == 3) node.name = PrintableText(message.Bytes(field));
      if (field.number == 4) node.op = PrintableText(message.Bytes(field));
      if (field.number == 5) attributes.push_back(message.Bytes(field));
      if (field.number == 7) standard = IsStandard(message.Bytes(field));
    }
    if (node.name.empty()) node.name = place;
    place = "node '" + node.name + "' (" + node.op + ")";
    if (!standard) ThrowFileError(name_, place, "an operator of its author's own, expected one of the standard");
    if (attributes.size() > kMaxAttributes) ThrowFileError(name_, place, Concatenate(attributes.size(), " attributes"));
    for (const std::string_view attribute : attributes) ReadAttribute(attribute, place, &node);
    for (const std::string& input : inputs) node.inputs.push_back(input.empty() ? -1 : Known(input, place));
    for (const std::string& output : outputs) node.outputs.push_back(output.empty() ? -1 : Define(output, place));
  }

  void ReadAttribute(std::string_view bytes, const std::string& place, GraphNode* node) {
    ProtoMessage message = Message(bytes, place);
    std::string name;
    GraphAttribute value;
    for (ProtoField field; message.Next(&field);) {
      switch (field.number) {
        case 1:
          name = message.Bytes(field);
          break;
        case 2:
        case 7:
          message.AddFloats(field, &value.floats);
          break;
        case 3:
        case 8:
          message.AddIntegers(field, &value.ints);
          break;
        case 4:
          value.text = message.Bytes(field);
          break;
        case 5:
          value.tensor = Tensor(Stored(message.Bytes(field), place), place);
          break;
        case 6:
        case 10:
        case 11:
          ThrowFileError(name_, place, "a graph within the graph, expected none");
        default:
          break;
      }
    }
    node->attributes[name] = std::move(value);
  }

  void AddConstant(std::string_view bytes) {
    const StoredTensor stored = Stored(bytes, "constants");
    const std::string name(stored.name);
    const int number = Define(name, "constants");
    OperatorGraph::Tensor& tensor = graph_.tensors[size_t(number)];
    tensor.constant = Tensor(stored, "constant '" + tensor.name + "'");
    tensor.shape = stored.shape;
  }

  [[nodiscard]] StoredTensor Stored(std::string_view bytes, const std::string& place) const {
    StoredTensor stored;
    ProtoMessage tensor = Message(bytes, place);
    for (ProtoField field; tensor.Next(&field);) {
      switch (field.number) {
        case 1:
          tensor.AddIntegers(field, &stored.shape);
          break;
        case 2:
          stored.type = tensor.Integer(field);
          break;
        case 4:
          tensor.AddFloats(field, &stored.floats);
          break;
        case 5:
        case 7:
          tensor.AddIntegers(field, &stored.ints);
          break;
        case 8:
          stored.name = tensor.Bytes(field);
          break;
        case 9:
          stored.raw = tensor.Bytes(field);
          stored.has_raw = true;
          break;
        case 14:
          if (tensor.Integer(field) != 0)
            ThrowFileError(name_, place, "weights in another file, expected them in this one");
          break;
        default:
          break;
      }
    }
    return stored;
  }

  GraphTensor Tensor(const StoredTensor& stored, const std::string& place) {
    if (stored.shape.size() > kMaxAxes) ThrowFileError(name_, place, Concatenate(stored.shape.size(), " axes"));
    size_t size = 0;
    try {
      size = GraphShapeSize(stored.shape);
    } catch (const std::runtime_error& error) {
      ThrowFileError(name_, place, error.what());
    }
    const bool is_float = stored.type == kOnnxFloat || stored.type == kOnnxHalf;
    const size_t bytes = size * (is_float ? sizeof(float) : sizeof(int64_t));
    if (bytes > budget_) ThrowFileError(name_, place, "constants that are much larger than the file");
    budget_ -= bytes;
    if (stored.has_raw) CheckBytes(stored, size, place);
    if (is_float) {
      std::vector<float> values = Floats(stored);
      CheckCount(values.size(), size, place);
      return {stored.shape, std::move(values)};
    }
    std::vector<int64_t> values = Ints(stored, place);
    CheckCount(values.size(), size, place);
    return {stored.shape, std::move(values)};
  }

  void CheckBytes(const StoredTensor& stored, size_t size, const std::string& place) const {
    const size_t each = stored.type == kOnnxInt64 ? 8 : stored.type == kOnnxHalf ? 2 : stored.type == kOnnxBool ? 1 : 4;
    if (stored.raw.size() != size * each) {
      ThrowFileError(name_, place,
                     Concatenate(stored.raw.size(), " bytes, expected ", size * each, " for a shape of ",
                                 GraphShapeText(stored.shape)));
    }
  }

  void CheckCount(size_t found, size_t size, const std::string& place) const {
    if (found != size) ThrowFileError(name_, place, Concatenate(found, " numbers, expected ", size));
  }

  static std::vector<float> Floats(const StoredTensor& stored) {
    if (stored.type == kOnnxFloat) {
      if (!stored.has_raw) return stored.floats;
      return Unpacked<float, float>(stored.raw, [](float value) { return value; });
    }
    if (stored.has_raw) return Unpacked<uint16_t, float>(stored.raw, FloatFromHalf);
    std::vector<float> values;
    for (const int64_t bits : stored.ints) values.push_back(FloatFromHalf(uint16_t(bits)));
    return values;
  }

  [[nodiscard]] std::vector<int64_t> Ints(const StoredTensor& stored, const std::string& place) const {
    const auto widen = [](auto value) { return int64_t(value); };
    switch (stored.type) {
      case kOnnxInt32:
        return stored.has_raw ? Unpacked<int32_t, int64_t>(stored.raw, widen) : stored.ints;
      case kOnnxInt64:
        return stored.has_raw ? Unpacked<int64_t, int64_t>(stored.raw, widen) : stored.ints;
      case kOnnxBool:
        return stored.has_raw ? Unpacked<uint8_t, int64_t>(stored.raw, widen) : stored.ints;
      default:
        ThrowFileError(
            name_, place,
            Concatenate("numbers of type ", stored.type, ", expected float32, float16, int32, int64 or bool"));
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  size_t budget_;
  OperatorGraph graph_;
  std::map<std::string, int> number_;  ///< of the tensor of that name
};

}  // namespace

OperatorGraph ParseOnnxGraph(std::string_view bytes, const std::string& name) { return OnnxReader(bytes, name).Read(); }

OperatorGraph ReadOnnxGraph(const std::string& path) { return ParseOnnxGraph(ReadFileBytes(path, kMaxBytes), path); }

}  // namespace bodyloom
