// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_reader.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"
#include "tracking/detection/inference/flatbuffer.h"
#include "tracking/detection/inference/operators.h"
#include "tracking/detection/inference/tflite_constants.h"
#include "tracking/detection/inference/tflite_shapes.h"

namespace bodyloom {
namespace {

constexpr uint32_t kSchemaVersion = 3;
constexpr size_t kMaxFileBytes = size_t{1} << 28;
constexpr size_t kMaxTables = 10'000;
constexpr size_t kMaxRank = 4;
constexpr size_t kMaxTensor = size_t{1} << 24, kMaxComputed = size_t{1} << 28;
constexpr size_t kMaxJoined = 64;  // inputs of a CONCATENATION
constexpr int kMaxWindow = 64;     // of a pooling
constexpr int kMaxStride = 3;
constexpr int kDequantize = 6, kDensify = 124;

/// Code and names of an operator, and its number of inputs. `options` is the type number of its table in the union of
/// options; 0 if there is none to read.
struct KnownOperator {
  TfliteKind kind;
  int code;
  const char *name, *op;  ///< the file's, the graph's
  size_t min_inputs, max_inputs;
  int options;
};
constexpr KnownOperator kKnown[] = {{TfliteKind::kAdd, 0, "ADD", "Add", 2, 2, 11},
                                    {TfliteKind::kConcatenation, 2, "CONCATENATION", "Concat", 1, kMaxJoined, 10},
                                    {TfliteKind::kConv2d, 3, "CONV_2D", "Conv", 2, 3, 1},
                                    {TfliteKind::kDepthwiseConv2d, 4, "DEPTHWISE_CONV_2D", "Conv", 2, 3, 2},
                                    {TfliteKind::kDepthToSpace, 5, "DEPTH_TO_SPACE", "DepthToSpace", 1, 1, 94},
                                    {TfliteKind::kFullyConnected, 9, "FULLY_CONNECTED", "Gemm", 2, 3, 8},
                                    {TfliteKind::kLogistic, 14, "LOGISTIC", "Sigmoid", 1, 1, 0},
                                    {TfliteKind::kMaxPool2d, 17, "MAX_POOL_2D", "MaxPool", 1, 1, 5},
                                    {TfliteKind::kReshape, 22, "RESHAPE", "Reshape", 2, 2, 0},
                                    {TfliteKind::kResizeBilinear, 23, "RESIZE_BILINEAR", "Resize", 2, 2, 15},
                                    {TfliteKind::kPad, 34, "PAD", "Pad", 2, 2, 0},
                                    {TfliteKind::kMean, 40, "MEAN", "ReduceMean", 2, 2, 27},
                                    {TfliteKind::kStridedSlice, 45, "STRIDED_SLICE", "Slice", 4, 4, 32},
                                    {TfliteKind::kPrelu, 54, "PRELU", "PRelu", 2, 2, 0}};

/// True if the inputs of the operator after the first are int32 constants.
bool TakesNumbers(TfliteKind kind) {
  return kind == TfliteKind::kMean || kind == TfliteKind::kPad || kind == TfliteKind::kReshape ||
         kind == TfliteKind::kResizeBilinear || kind == TfliteKind::kStridedSlice;
}

/// True if they are float constants.
bool TakesWeights(TfliteKind kind) {
  return kind == TfliteKind::kConv2d || kind == TfliteKind::kDepthwiseConv2d || kind == TfliteKind::kFullyConnected ||
         kind == TfliteKind::kPrelu;
}

std::string KnownNames() {
  std::vector<std::string> names;
  for (const KnownOperator& known : kKnown) names.emplace_back(known.name);
  return PrintableList(names) + ", DEQUANTIZE or DENSIFY";
}

/// A tensor as the file describes it.
struct Description {
  TfliteType type = TfliteType::kFloat32;
  TfliteStored stored;    ///< float16 also behind a folded DEQUANTIZE
  bool constant = false;  ///< it has values …
  bool packed = false;    ///< … and is sparse, so that only DENSIFY may read it
  bool computed = false;  ///< an input of the network, or written by an operator that was read
};

class TfliteReader {
 public:
  TfliteReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name), budget_(bytes.size()) {
    graph_.name = name;
    graph_.opset = 13;
    graph_.channels_last = true;
  }

  OperatorGraph Read() {
    const FlatTable root = FlatTable::Root(bytes_, "TFL3", name_);
    if (const auto version = root.Number<uint32_t>(0, 0); version != kSchemaVersion) {
      Fail("model", Concatenate("schema version ", version, ", expected ", kSchemaVersion));
    }
    ReadCodes(root.Tables(1, kMaxTables));
    const std::vector<FlatTable> graphs = root.Tables(2, kMaxTables);
    if (graphs.size() != 1) Fail("model", Concatenate(graphs.size(), " subgraphs, expected 1"));
    ReadTensors(graphs[0].Tables(0, kMaxTables), root.Tables(4, kMaxTables));
    graph_.inputs = Ends(graphs[0], 1, "inputs");
    for (const int input : graph_.inputs) {
      if (descriptions_[input].constant)
        Fail(TensorPlace(input), "an input of the network that is constant, expected none of its values");
      MarkComputed(input, TensorPlace(input));
    }
    const std::vector<FlatTable> operators = graphs[0].Tables(3, kMaxTables);
    for (size_t i = 0; i < operators.size(); ++i) ReadOperator(operators[i], i);
    graph_.outputs = Ends(graphs[0], 2, "outputs");
    for (const int output : graph_.outputs) {
      const bool input = std::count(graph_.inputs.begin(), graph_.inputs.end(), output) != 0;
      if (!descriptions_[output].computed || input) {
        Fail(TensorPlace(output), "an output of the network that no operator writes, expected one that is computed");
      }
    }
    return std::move(graph_);
  }

 private:
  [[noreturn]] void Fail(const std::string& place, const std::string& message) const {
    throw std::runtime_error(name_ + ": " + place + ": " + message);
  }

  [[nodiscard]] std::string TensorPlace(int tensor) const {
    return Concatenate("tensor ", tensor, " '", graph_.tensors[tensor].name, "'");
  }

  void ReadCodes(const std::vector<FlatTable>& tables) {
    for (const FlatTable& table : tables) {
      codes_.push_back(std::max(int32_t{table.Number<int8_t>(0, 0)}, table.Number<int32_t>(3, 0)));
      custom_.push_back(PrintableText(table.Bytes(1)));
    }
  }

  void ReadTensors(const std::vector<FlatTable>& tables, const std::vector<FlatTable>& buffers) {
    descriptions_.resize(tables.size());
    for (size_t i = 0; i < tables.size(); ++i) {
      OperatorGraph::Tensor& tensor = graph_.tensors.emplace_back();
      tensor.name = PrintableText(tables[i].Bytes(3));
      const std::string place = TensorPlace(static_cast<int>(i));
      const int type = tables[i].Number<uint8_t>(1, 0);
      if (type > 2) {
        Fail(place, Concatenate("type ", type, ", expected 0 (float32), 1 (float16) or 2 (int32)"));
      }
      if (tables[i].Number<uint8_t>(5, 0) != 0) Fail(place, "a variable, expected a constant or a computed tensor");
      tensor.shape = Shape(tables[i], place);
      const auto buffer = tables[i].Number<uint32_t>(2, 0);
      if (buffer >= buffers.size()) {
        Fail(place, Concatenate("buffer ", buffer, ", expected less than ", buffers.size()));
      }
      Description& description = descriptions_[i];
      description.type = static_cast<TfliteType>(type);
      description.stored = {description.type, buffers[buffer].Bytes(0), tables[i].Table(6)};
      description.constant = !description.stored.bytes.empty();
      description.packed = description.stored.sparsity.has_value();
    }
  }

  [[nodiscard]] std::vector<int64_t> Shape(const FlatTable& table, const std::string& place) const {
    const FlatNumbers<int32_t> sides = table.Numbers<int32_t>(0), signature = table.Numbers<int32_t>(7);
    if (sides.size() < 1 || sides.size() > kMaxRank) {
      Fail(place, Concatenate(sides.size(), " axes, expected 1 to ", kMaxRank));
    }
    std::vector<int64_t> shape;
    size_t size = 1;
    for (size_t i = 0; i < sides.size(); ++i) {
      if (i < signature.size() && signature[i] < 0)
        Fail(place, Concatenate("axis ", i, " is dynamic, expected a size"));
      if (sides[i] < 1 || static_cast<size_t>(sides[i]) > kMaxTensor / size) {
        Fail(place, Concatenate("axis ", i, " of size ", sides[i], ", expected 1 or more and at most ", kMaxTensor,
                                " numbers in all"));
      }
      size *= static_cast<size_t>(sides[i]);
      shape.push_back(sides[i]);
    }
    return shape;
  }

  /// Inputs or outputs of the network.
  [[nodiscard]] std::vector<int> Ends(const FlatTable& graph, int field, const char* what) const {
    const FlatNumbers<int32_t> places = graph.Numbers<int32_t>(field);
    if (places.size() < 1 || places.size() > descriptions_.size()) {
      Fail("subgraph", Concatenate(places.size(), " ", what, ", expected 1 to ", descriptions_.size()));
    }
    std::vector<int> ends;
    for (size_t i = 0; i < places.size(); ++i) {
      ends.push_back(Tensor(places[i], "subgraph"));
      if (descriptions_[ends.back()].type != TfliteType::kFloat32) {
        Fail(TensorPlace(ends.back()), Concatenate("among the ", what, ", expected float32"));
      }
    }
    return ends;
  }

  [[nodiscard]] int Tensor(int place, const std::string& where) const {
    if (place < 0 || place >= static_cast<int>(descriptions_.size())) {
      Fail(where, Concatenate("tensor ", place, ", expected 0 to ", descriptions_.size() - 1));
    }
    return place;
  }

  void MarkComputed(int tensor, const std::string& place) {
    if (descriptions_[tensor].computed || descriptions_[tensor].constant) {
      Fail(place, Concatenate("writes tensor ", tensor,
                              ", which has its values already, expected one that nothing else writes"));
    }
    descriptions_[tensor].computed = true;
    computed_ += GraphShapeSize(graph_.tensors[tensor].shape);
    if (computed_ > kMaxComputed) Fail(place, Concatenate("more than ", kMaxComputed, " numbers to compute in all"));
  }

  void ReadOperator(const FlatTable& table, size_t number) {
    std::string place = Concatenate("operator ", number);
    const auto place_of_code = table.Number<uint32_t>(0, 0);
    if (place_of_code >= codes_.size()) {
      Fail(place, Concatenate("code ", place_of_code, ", expected less than ", codes_.size()));
    }
    const int code = codes_[place_of_code];
    const FlatNumbers<int32_t> inputs = table.Numbers<int32_t>(1), outputs = table.Numbers<int32_t>(2);
    if (outputs.size() != 1) Fail(place, Concatenate(outputs.size(), " outputs, expected 1"));
    const int output = Tensor(outputs[0], place);
    if (code == kDequantize || code == kDensify) {
      place += code == kDensify ? " (DENSIFY)" : " (DEQUANTIZE)";
      if (inputs.size() != 1) Fail(place, Concatenate(inputs.size(), " inputs, expected 1"));
      Fold(code, Tensor(inputs[0], place), output, place);
      return;
    }
    const auto* known =
        std::find_if(std::begin(kKnown), std::end(kKnown), [&](const auto& k) { return k.code == code; });
    if (known == std::end(kKnown)) {
      Fail(place, Concatenate("operator code ", code,
                              custom_[place_of_code].empty() ? "" : " '" + custom_[place_of_code] + "'", ", expected ",
                              KnownNames()));
    }
    place += Concatenate(" (", known->name, ")");
    if (inputs.size() < known->min_inputs || inputs.size() > known->max_inputs) {
      Fail(place, Concatenate(inputs.size(), " inputs, expected ", known->min_inputs, " to ", known->max_inputs));
    }
    TfliteOperator op;
    op.kind = known->kind;
    for (size_t i = 0; i < inputs.size(); ++i) {
      if (inputs[i] == -1 && i == 2) continue;  // no bias
      op.inputs.push_back(Tensor(inputs[i], place));
      ResolveInput(op, i, place);
    }
    op.output = output;
    ReadOptions(table, *known, place, &op);
    CheckOutput(op, place);
    MarkComputed(output, place);
    AddNodes(op, known->op, place);
  }

  /// DEQUANTIZE and DENSIFY: their output is the same constant under another description, unpacked by its readers.
  void Fold(int code, int input, int output, const std::string& place) {
    const Description& from = descriptions_[input];
    const bool densify = code == kDensify;
    if (!from.constant || from.packed != densify || from.type == TfliteType::kInt32 ||
        (!densify && from.type != TfliteType::kFloat16)) {
      Fail(place, Concatenate("of tensor ", input, ", expected a ", densify ? "sparse" : "dense float16", " constant"));
    }
    Description& to = descriptions_[output];
    const TfliteType expected = densify ? from.type : TfliteType::kFloat32;
    if (to.constant || to.computed || to.packed || to.type != expected ||
        graph_.tensors[output].shape != graph_.tensors[input].shape) {
      Fail(place, Concatenate("into tensor ", output, " of shape ", GraphShapeText(graph_.tensors[output].shape),
                              ", expected one of shape ", GraphShapeText(graph_.tensors[input].shape), " and type ",
                              int{static_cast<int8_t>(expected)}, " that nothing else writes"));
    }
    to.stored = from.stored;
    to.constant = true;
  }

  /// Checks that the input added last is valid at position `i` of an operator of this kind; unpacks constants.
  void ResolveInput(const TfliteOperator& op, size_t i, const std::string& place) {
    const int input = op.inputs.back();
    const Description& description = descriptions_[input];
    OperatorGraph::Tensor& tensor = graph_.tensors[input];
    const bool numbers = TakesNumbers(op.kind);
    if (i == 0 || !(TakesWeights(op.kind) || numbers)) {
      if (!description.computed) {
        Fail(place, Concatenate("input ", i, " is tensor ", input, ", expected one that was computed before"));
      }
      return;
    }
    const TfliteType expected = numbers ? TfliteType::kInt32 : TfliteType::kFloat32;
    if (!description.constant || description.packed || description.type != expected) {
      Fail(place, Concatenate("input ", i, " is tensor ", input, ", expected a dense constant of ",
                              numbers ? "int32" : "float32"));
    }
    const std::string where = name_ + ": " + TensorPlace(input);
    if (tensor.constant.has_numbers()) return;
    tensor.constant = numbers ? TfliteInts(description.stored, tensor.shape, where, &budget_)
                              : TfliteFloats(description.stored, tensor.shape, where, &budget_);
  }

  void ReadOptions(const FlatTable& table, const KnownOperator& known, const std::string& place, TfliteOperator* op) {
    if (known.options == 0) return;
    const int kind = table.Number<uint8_t>(3, 0);
    const std::optional<FlatTable> options = table.Table(4);
    if (kind != known.options || !options) {
      Fail(place, Concatenate("options of kind ", kind, ", expected ", known.options));
    }
    const auto window = [&](int stride_w, int stride_h) {
      const int padding = options->Number<uint8_t>(0, 0);
      if (padding != 0 && padding != 1)
        Fail(place, Concatenate("padding ", padding, ", expected 0 (SAME) or 1 (VALID)"));
      op->same_padding = padding == 0;
      op->stride_w = options->Number<int32_t>(stride_w, 0);
      op->stride_h = options->Number<int32_t>(stride_h, 0);
      if (std::min(op->stride_w, op->stride_h) < 1 || std::max(op->stride_w, op->stride_h) > kMaxStride) {
        Fail(place, Concatenate("strides ", op->stride_h, " and ", op->stride_w, ", expected 1 to ", kMaxStride));
      }
    };
    const auto activation = [&](int field) {
      const int found = options->Number<uint8_t>(field, 0);
      if (found != 0 && found != 3) Fail(place, Concatenate("activation ", found, ", expected 0 (none) or 3 (relu6)"));
      op->relu6 = found == 3;
    };
    const auto exactly = [&](const char* what, int found, int expected) {
      if (found != expected) Fail(place, Concatenate(what, " ", found, ", expected ", expected));
    };
    const auto sides = [&](int64_t height, int64_t width) {
      if (std::min(height, width) < 1 || std::max(height, width) > kMaxWindow) {
        Fail(place, Concatenate("a window of ", height, "x", width, ", expected sides of 1 to ", kMaxWindow));
      }
      op->filter_h = static_cast<int>(height);
      op->filter_w = static_cast<int>(width);
    };
    const auto kernel = [&] {
      const std::vector<int64_t>& shape = graph_.tensors[op->inputs[1]].shape;
      exactly("axes of the kernel:", static_cast<int>(shape.size()), 4);
      sides(shape[1], shape[2]);
    };
    switch (known.kind) {
      case TfliteKind::kAdd:
        activation(0);
        break;
      case TfliteKind::kConcatenation:
        op->axis = options->Number<int32_t>(0, 0);
        if (op->axis < 0 && op->axis >= -static_cast<int>(kMaxRank)) {
          op->axis += static_cast<int>(graph_.tensors[op->inputs[0]].shape.size());
        }
        activation(1);
        break;
      case TfliteKind::kConv2d:
        window(1, 2);
        activation(3);
        exactly("dilation", options->Number<int32_t>(4, 1), 1);
        exactly("dilation", options->Number<int32_t>(5, 1), 1);
        kernel();
        break;
      case TfliteKind::kDepthwiseConv2d:
        window(1, 2);
        exactly("channel multiplier", options->Number<int32_t>(3, 0), 1);
        activation(4);
        exactly("dilation", options->Number<int32_t>(5, 1), 1);
        exactly("dilation", options->Number<int32_t>(6, 1), 1);
        kernel();
        break;
      case TfliteKind::kDepthToSpace:
        op->block_size = options->Number<int32_t>(0, 0);
        break;
      case TfliteKind::kFullyConnected:
        activation(0);
        exactly("weights format", options->Number<uint8_t>(1, 0), 0);
        break;
      case TfliteKind::kMean:
        op->keeps_axes = options->Number<uint8_t>(0, 0) != 0;
        break;
      case TfliteKind::kStridedSlice:
        for (int mask = 0; mask < 5; ++mask) exactly("mask", options->Number<int32_t>(mask, 0), 0);
        break;
      case TfliteKind::kMaxPool2d:
        window(1, 2);
        sides(options->Number<int32_t>(4, 0), options->Number<int32_t>(3, 0));
        activation(5);
        break;
      case TfliteKind::kResizeBilinear:
        exactly("align_corners", options->Number<uint8_t>(2, 0), 0);
        exactly("half_pixel_centers", options->Number<uint8_t>(3, 0), 1);
        break;
      case TfliteKind::kLogistic:
      case TfliteKind::kPad:
      case TfliteKind::kPrelu:
      case TfliteKind::kReshape:
        break;
    }
  }

  void CheckOutput(const TfliteOperator& op, const std::string& place) const {
    if (descriptions_[op.output].type != TfliteType::kFloat32) {
      Fail(place, Concatenate("writes tensor ", op.output, ", expected one of float32"));
    }
    const std::vector<int64_t> expected = TfliteOutputShape(graph_, op, name_ + ": " + place);
    if (graph_.tensors[op.output].shape != expected) {
      Fail(place, Concatenate("an output of shape ", GraphShapeText(graph_.tensors[op.output].shape), ", expected ",
                              GraphShapeText(expected)));
    }
  }

  /// The operator as the standard's, relu6 as a Clip behind it.
  void AddNodes(const TfliteOperator& op, const char* name, const std::string& place) {
    const std::vector<int64_t> in = graph_.tensors[op.inputs[0]].shape, out = graph_.tensors[op.output].shape;
    GraphNode node;
    node.name = place;
    node.op = name;
    node.inputs = op.inputs;
    const auto set = [&node](const char* name, std::vector<int64_t> numbers) {
      node.attributes[name] = GraphAttribute::Ints(std::move(numbers));
    };
    switch (op.kind) {
      case TfliteKind::kAdd:
      case TfliteKind::kLogistic:
      case TfliteKind::kPrelu:
        break;
      case TfliteKind::kConcatenation:
        set("axis", {op.axis});
        break;
      case TfliteKind::kConv2d:
      case TfliteKind::kDepthwiseConv2d:
        set("strides", {op.stride_h, op.stride_w});
        if (op.kind == TfliteKind::kDepthwiseConv2d) set("group", {in[3]});
        if (op.same_padding) {
          const TflitePads rows = SamePads(static_cast<int>(in[1]), op.filter_h, op.stride_h),
                           columns = SamePads(static_cast<int>(in[2]), op.filter_w, op.stride_w);
          set("pads", {rows.before, columns.before, rows.after, columns.after});
        }
        break;
      case TfliteKind::kDepthToSpace:
        set("blocksize", {op.block_size});
        break;
      case TfliteKind::kFullyConnected:
        set("transB", {1});
        break;
      case TfliteKind::kMean:
        set("axes", graph_.tensors[op.inputs[1]].constant.ints.Copy());
        set("keepdims", {op.keeps_axes ? 1 : 0});
        break;
      case TfliteKind::kMaxPool2d:
        set("kernel_shape", {op.filter_h, op.filter_w});
        set("strides", {op.stride_h, op.stride_w});
        break;
      case TfliteKind::kPad: {
        const SharedNumbers<int64_t>& n = graph_.tensors[op.inputs[1]].constant.ints;
        set("pads", {n[0], n[2], n[4], n[6], n[1], n[3], n[5], n[7]});
        break;
      }
      case TfliteKind::kReshape:
        set("shape", out);
        break;
      case TfliteKind::kResizeBilinear:
        node.attributes["mode"] = GraphAttribute::Text("linear");
        set("sizes", out);
        break;
      case TfliteKind::kStridedSlice:
        set("starts", graph_.tensors[op.inputs[1]].constant.ints.Copy());
        set("ends", graph_.tensors[op.inputs[2]].constant.ints.Copy());
        break;
    }
    if (TakesNumbers(op.kind)) node.inputs.resize(1);  // they are attributes here
    node.outputs = {op.output};
    if (op.relu6) {
      GraphNode clip;
      clip.name = place;
      clip.op = "Clip";
      clip.inputs = node.outputs = {static_cast<int>(graph_.tensors.size())};
      clip.outputs = {op.output};
      clip.attributes["min"] = GraphAttribute::Floats({0});
      clip.attributes["max"] = GraphAttribute::Floats({6});
      graph_.tensors.push_back({graph_.tensors[op.output].name + " before relu6", out, {}});
      graph_.nodes.push_back(std::move(node));
      node = std::move(clip);
    }
    graph_.nodes.push_back(std::move(node));
  }

  std::string_view bytes_;
  const std::string& name_;
  TfliteBudget budget_;
  OperatorGraph graph_;
  std::vector<int> codes_;
  std::vector<std::string> custom_;
  std::vector<Description> descriptions_;  ///< of each of the file's tensors
  size_t computed_ = 0;
};

}  // namespace

OperatorGraph ParseTfliteGraph(std::string_view bytes, const std::string& name) {
  if (bytes.size() > kMaxFileBytes) {
    throw std::runtime_error(Concatenate(name, ": ", bytes.size(), " bytes, expected at most ", kMaxFileBytes));
  }
  return TfliteReader(bytes, name).Read();
}

OperatorGraph ReadTfliteGraph(const std::string& path) {
  return ParseTfliteGraph(ReadFileBytes(path, kMaxFileBytes), path);
}

OperatorGraph ReadImageNetwork(const std::string& path, int size, const std::vector<size_t>& outputs) {
  OperatorGraph graph = ReadTfliteGraph(path);
  const std::vector<int64_t> expected = {1, size, size, 3};
  bool fits = graph.inputs.size() == 1 && graph.tensors[size_t(graph.inputs[0])].shape == expected &&
              graph.outputs.size() == outputs.size();
  for (size_t i = 0; fits && i < outputs.size(); ++i) {
    fits = GraphShapeSize(graph.tensors[size_t(graph.outputs[i])].shape) == outputs[i];
  }
  if (!fits) {
    throw std::runtime_error(Concatenate(graph.name, ": another network, expected one of MediaPipe with an input of ",
                                         size, "x", size, "x3 and ", outputs.size(), " outputs"));
  }
  return graph;
}

}  // namespace bodyloom
