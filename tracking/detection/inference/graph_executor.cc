// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/graph_executor.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/channels_last.h"
#include "tracking/detection/inference/onednn_operator.h"
#include "tracking/detection/inference/operators.h"

namespace bodyloom {
namespace {

/// Folds Pad of rows and columns into the padding of the convolutions that read it.
void FoldPads(const OperatorGraph& graph, std::vector<GraphNode>* nodes) {
  std::vector<const GraphNode*> writer(graph.tensors.size(), nullptr);
  const size_t row = graph.channels_last ? 1 : 2, column = row + 1;
  for (GraphNode& node : *nodes) {
    for (const int output : node.outputs) {
      if (output >= 0) writer[size_t(output)] = &node;
    }
    if (node.op != "Conv" || node.Has("auto_pad") || node.inputs.size() < 2 || node.inputs[0] < 0 || node.inputs[1] < 0)
      continue;
    const GraphNode* pad = writer[size_t(node.inputs[0])];
    const std::vector<int64_t>& kernel = graph.tensors[size_t(node.inputs[1])].shape;
    if (pad == nullptr || pad->op != "Pad" || pad->Has("mode") || kernel.size() != 4) continue;
    const std::vector<int64_t> n = pad->Integers("pads", {}), dilations = node.Integers("dilations", {1, 1});
    std::vector<int64_t> pads = node.Integers("pads", {0, 0, 0, 0});
    if (n.size() != 8 || pads.size() != 4 || dilations.size() != 2) continue;
    bool fits = true;
    for (size_t axis = 0; axis < 4; ++axis) {
      if (axis != row && axis != column) fits = fits && n[axis] == 0 && n[axis + 4] == 0;
    }
    for (size_t i = 0; i < 4; ++i) {  // rows before, columns before, rows after, columns after
      pads[i] += n[(i % 2 == 0 ? row : column) + (i < 2 ? 0 : 4)];
      fits = fits && pads[i] >= 0 && pads[i] <= dilations[i % 2] * (kernel[row + i % 2] - 1);
    }
    if (!fits) continue;
    node.inputs[0] = pad->inputs[0];
    node.attributes["pads"].ints = pads;
  }
}

/// The nodes that these tensors need.
std::vector<GraphNode> NeededNodes(std::vector<GraphNode> nodes, size_t num_tensors, const std::vector<int>& wanted) {
  std::vector<bool> needed(num_tensors, false);
  for (const int tensor : wanted) needed[size_t(tensor)] = true;
  std::vector<GraphNode> kept;
  for (size_t i = nodes.size(); i-- > 0;) {
    if (std::none_of(nodes[i].outputs.begin(), nodes[i].outputs.end(),
                     [&needed](int output) { return output >= 0 && needed[size_t(output)]; }))
      continue;
    for (const int input : nodes[i].inputs) {
      if (input >= 0) needed[size_t(input)] = true;
    }
    kept.push_back(std::move(nodes[i]));
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace

class GraphExecutor::Program {
 public:
  Program(const OperatorGraph& graph, std::vector<int64_t> shape)
      : name_(graph.name),
        settings_{graph.opset, graph.channels_last, nullptr},
        input_shape_(std::move(shape)),
        input_(graph.inputs[0]),
        outputs_(graph.outputs) {
    for (const OperatorGraph::Tensor& tensor : graph.tensors) {
      constants_.push_back(tensor.constant);
      is_constant_.push_back(tensor.constant.has_numbers());
    }
    nodes_ = graph.nodes;
    FoldPads(graph, &nodes_);
    nodes_ = NeededNodes(std::move(nodes_), graph.tensors.size(), outputs_);
    Build();
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<int64_t>& input_shape() const { return input_shape_; }
  [[nodiscard]] const std::vector<std::vector<int64_t>>& output_shapes() const { return output_shapes_; }
  [[nodiscard]] size_t num_steps() const { return steps_.size(); }

  [[nodiscard]] size_t num_outputs() const { return outputs_.size(); }

  std::vector<GraphTensor> Run(std::vector<float> input, size_t num_outputs) const {
    std::unique_ptr<Workspace> workspace = IdleWorkspace();
    std::vector<GraphTensor>& values = workspace->values;
    values[size_t(input_)] = GraphTensor(input_shape_, std::move(input));
    for (size_t i = 0; i < steps_.size(); ++i) {
      if (steps_[i].first_output >= num_outputs) continue;
      Execute(steps_[i], &workspace->memories[i], workspace.get());
      for (const int tensor : steps_[i].last) values[size_t(tensor)] = GraphTensor();
    }
    std::vector<GraphTensor> outputs;
    for (size_t i = 0; i < num_outputs; ++i) {
      const GraphTensor& tensor = ValueOf(outputs_[i], *workspace);
      outputs.emplace_back(tensor.shape, tensor.floats.Copy());
    }
    values.assign(values.size(), GraphTensor());
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
    return outputs;
  }

 private:
  /// An operator with those fused into it.
  struct Step {
    GraphNode node;  ///< its outputs are those of the last operator that it does
    OperatorFunction run = nullptr;
    std::optional<OnednnOperator> onednn;  ///< instead of `run`
    bool in_place = false;                 ///< writes to the memory of its input 1
    std::vector<int> last;                 ///< tensors that are not read later
    size_t first_output = 0;               ///< the first of the wanted outputs that needs it
  };

  /// Mutable state of a run.
  struct Workspace {
    FloatPool pool;
    std::vector<GraphTensor> values;               ///< of each tensor that is computed, while it is needed
    std::vector<OnednnOperator::Memory> memories;  ///< of each step
  };

  [[noreturn]] void Fail(const GraphNode& node, const std::string& what) const {
    throw std::runtime_error(name_ + ": node '" + node.name + "' (" + node.op + "): " + what);
  }

  /// Calls function() and rethrows its errors with the node's name.
  template <typename Function>
  void OfNode(const GraphNode& node, const Function& function) const {
    try {
      function();
    } catch (const dnnl::error& error) {
      Fail(node, std::string("oneDNN: ") + error.what());
    } catch (const std::invalid_argument& error) {
      Fail(node, error.what());
    } catch (const std::runtime_error& error) {
      Fail(node, error.what());
    }
  }

  [[nodiscard]] std::unique_ptr<Workspace> IdleWorkspace() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) {
      auto made = std::make_unique<Workspace>();
      made->values.resize(constants_.size());
      made->memories.resize(steps_.size());
      return made;
    }
    std::unique_ptr<Workspace> workspace = std::move(idle_.back());
    idle_.pop_back();
    return workspace;
  }

  [[nodiscard]] bool IsConstant(int tensor) const { return tensor < 0 || is_constant_[size_t(tensor)]; }

  [[nodiscard]] const GraphTensor& ValueOf(int tensor, const Workspace& workspace) const {
    return IsConstant(tensor) ? constants_[size_t(tensor)] : workspace.values[size_t(tensor)];
  }

  [[nodiscard]] std::vector<const GraphTensor*> Inputs(const GraphNode& node, const Workspace& workspace) const {
    std::vector<const GraphTensor*> inputs;
    inputs.reserve(node.inputs.size());
    for (const int input : node.inputs) inputs.push_back(input < 0 ? nullptr : &ValueOf(input, workspace));
    return inputs;
  }

  [[nodiscard]] OperatorSettings SettingsFor(Workspace* workspace) const {
    OperatorSettings settings = settings_;
    settings.pool = &workspace->pool;
    return settings;
  }

  void Execute(const Step& step, OnednnOperator::Memory* memory, Workspace* workspace) const {
    const std::vector<const GraphTensor*> inputs = Inputs(step.node, *workspace);
    OfNode(step.node, [&] {
      if (step.onednn) {
        Keep(step.node, {step.onednn->Run(inputs, Target(step, workspace), memory, &workspace->pool)}, workspace);
      } else {
        Keep(step.node, step.run(OperatorArguments(step.node, SettingsFor(workspace), inputs)), workspace);
      }
    });
  }

  /// Memory for the result of a step on oneDNN.
  [[nodiscard]] NewNumbers<float> Target(const Step& step, Workspace* workspace) const {
    const size_t size = GraphShapeSize(step.onednn->shape());
    return {step.in_place ? workspace->values[size_t(step.node.inputs[1])].floats.Overwritten()
                          : workspace->pool.Take(size),
            size};
  }

  /// Stores the results that the node names. Results that it does not name are discarded; outputs that the operator
  /// does not compute (Dropout's mask) stay without numbers.
  static void Keep(const GraphNode& node, std::vector<GraphTensor> results, Workspace* workspace) {
    results.resize(std::max(results.size(), node.outputs.size()));
    for (size_t i = 0; i < node.outputs.size(); ++i) {
      if (node.outputs[i] >= 0) workspace->values[size_t(node.outputs[i])] = std::move(results[i]);
    }
  }

  // --- making the steps

  /// The steps, tried out one after the other on zeros. A step on oneDNN is not run for that, as its shape is known.
  void Build() {
    uses_.resize(constants_.size(), 0);
    for (const GraphNode& node : nodes_) {
      for (const int input : node.inputs) {
        if (input >= 0) ++uses_[size_t(input)];
      }
    }
    for (const int output : outputs_) ++uses_[size_t(output)];
    done_.resize(nodes_.size(), false);
    std::unique_ptr<Workspace> workspace = IdleWorkspace();
    workspace->values[size_t(input_)] = GraphTensor(input_shape_, std::vector<float>(GraphShapeSize(input_shape_), 0));
    for (size_t i = 0; i < nodes_.size(); ++i) {
      if (!done_[i]) AddStep(i, workspace.get());
    }
    for (const int output : outputs_) {
      const GraphTensor& tensor = ValueOf(output, *workspace);
      if (!tensor.has_floats()) throw std::runtime_error(name_ + ": an output of whole numbers, expected floats");
      output_shapes_.push_back(tensor.shape);
    }
    FindLastUses();
    FindFirstOutputs();
    nodes_.clear();
  }

  void AddStep(size_t i, Workspace* workspace) {
    Step step;
    step.node = nodes_[i];
    step.run = FindOperator(step.node.op);
    OfNode(nodes_[i], [&] { MakeOnednn(i, workspace, &step); });
    if (!step.onednn && step.run == nullptr) Fail(step.node, "an operator that is not known here");
    const bool constant = std::all_of(step.node.inputs.begin(), step.node.inputs.end(),
                                      [this](int tensor) { return IsConstant(tensor); });
    if (step.onednn && !constant) {
      const NewNumbers<float> zeros = Target(step, workspace);
      std::fill(zeros.begin(), zeros.end(), 0.0F);
      Keep(step.node, {GraphTensor(step.onednn->shape(), zeros)}, workspace);
    } else {
      OnednnOperator::Memory memory;
      Execute(step, &memory, workspace);
    }
    for (const int tensor : step.node.inputs) {
      if (tensor >= 0 && --uses_[size_t(tensor)] == 0 && !IsConstant(tensor)) {
        workspace->values[size_t(tensor)] = GraphTensor();
      }
    }
    if (!constant) {
      steps_.push_back(std::move(step));
      return;
    }
    for (const int output : step.node.outputs) {
      if (output < 0) continue;
      constants_[size_t(output)] = std::move(workspace->values[size_t(output)]);
      is_constant_[size_t(output)] = true;
    }
  }

  /// Makes node i a step on oneDNN if that supports it, fused with the nodes after it where possible.
  void MakeOnednn(size_t i, Workspace* workspace, Step* step) {
    const std::vector<const GraphTensor*> inputs = Inputs(step->node, *workspace);
    const OperatorSettings settings = SettingsFor(workspace);
    const OperatorArguments arguments(nodes_[i], settings, inputs);
    std::vector<bool> is_constant;
    for (const int input : step->node.inputs) is_constant.push_back(IsConstant(input));
    FusedOperators fused;
    int summand = -1;
    if (nodes_[i].op == "Conv") {
      FuseSwish(i, step, &fused);
      if (!fused.swish) summand = FuseSum(i, arguments, *workspace, step, &fused);
    }
    const bool is_sum = nodes_[i].op == "Add" && inputs.size() == 2 && inputs[0] != nullptr && inputs[1] != nullptr &&
                        inputs[0]->shape == inputs[1]->shape && inputs[0]->has_floats() && inputs[0]->size() > 0;
    if (!fused.swish && (nodes_[i].op == "Conv" || is_sum)) FuseClip(i, step, &fused);
    step->onednn = OnednnOperator::Make(arguments, is_constant, fused);
    if (!step->onednn) return;
    step->node.inputs.resize(step->onednn->num_inputs());
    step->in_place = summand >= 0;
    if (step->in_place) step->node.inputs.push_back(summand);
  }

  /// The nodes after node i that read this tensor; none unless it has exactly `count` uses (the graph's outputs count).
  [[nodiscard]] std::vector<size_t> ReadersOf(int tensor, size_t i, int count) const {
    std::vector<size_t> readers;
    if (tensor < 0 || uses_[size_t(tensor)] != count) return readers;
    for (size_t k = i + 1; k < nodes_.size(); ++k) {
      const std::vector<int>& inputs = nodes_[k].inputs;
      if (std::find(inputs.begin(), inputs.end(), tensor) != inputs.end()) readers.push_back(k);
    }
    return readers;
  }

  /// Marks node k as done by this step, whose outputs become those of the node.
  void Take(size_t k, Step* step) {
    done_[k] = true;
    step->node.outputs = nodes_[k].outputs;
  }

  static int ResultOf(const Step& step) { return step.node.outputs.size() == 1 ? step.node.outputs[0] : -1; }

  void FuseSwish(size_t i, Step* step, FusedOperators* fused) {
    const int x = ResultOf(*step);
    const std::vector<size_t> readers = ReadersOf(x, i, 2);
    if (readers.size() != 2) return;
    const bool swapped = nodes_[readers[0]].op == "Mul";
    const size_t sigmoid = readers[swapped ? 1 : 0], product = readers[swapped ? 0 : 1];
    if (nodes_[sigmoid].op != "Sigmoid" || nodes_[sigmoid].outputs.size() != 1 || nodes_[product].op != "Mul") return;
    if (ReadersOf(nodes_[sigmoid].outputs[0], sigmoid, 1) != std::vector<size_t>{product}) return;
    fused->swish = true;
    done_[sigmoid] = true;
    Take(product, step);
  }

  /// The tensor to which the next node adds the convolution's result, if both have one shape and the tensor is not read
  /// later; −1 otherwise.
  int FuseSum(size_t i, const OperatorArguments& arguments, const Workspace& workspace, Step* step,
              FusedOperators* fused) {
    const int x = ResultOf(*step);
    size_t next = i + 1;
    while (next < nodes_.size() && (done_[next] || nodes_[next].op == "Pad")) ++next;
    if (next >= nodes_.size() || nodes_[next].op != "Add" || nodes_[next].inputs.size() != 2 || x < 0) return -1;
    const std::vector<int>& terms = nodes_[next].inputs;
    if (uses_[size_t(x)] != 1 || (terms[0] == x) == (terms[1] == x)) return -1;
    const int other = terms[terms[0] == x ? 1 : 0];
    if (IsConstant(other) || uses_[size_t(other)] != 1) return -1;
    const GraphTensor& value = workspace.values[size_t(other)];
    constexpr long kPoolAndTensor = 2;
    if (!value.has_floats() || value.floats.num_holders() != kPoolAndTensor ||
        value.shape != OnednnOperator::ConvolvedShape(arguments))
      return -1;
    fused->sum = true;
    Take(next, step);
    return other;
  }

  void FuseClip(size_t i, Step* step, FusedOperators* fused) {
    const std::vector<size_t> readers = ReadersOf(ResultOf(*step), i, 1);
    if (readers.size() != 1 || nodes_[readers[0]].op != "Clip") return;
    const GraphNode& clip = nodes_[readers[0]];
    std::vector<const GraphTensor*> bounds = {nullptr};
    for (size_t k = 1; k < clip.inputs.size(); ++k) {
      if (!IsConstant(clip.inputs[k])) return;
      bounds.push_back(clip.inputs[k] < 0 ? nullptr : &constants_[size_t(clip.inputs[k])]);
    }
    fused->clip = ClipBounds(OperatorArguments(clip, settings_, bounds));
    Take(readers[0], step);
  }

  void FindLastUses() {
    std::vector<bool> needed(constants_.size(), false);
    for (const int output : outputs_) needed[size_t(output)] = true;
    for (size_t i = steps_.size(); i-- > 0;) {
      Step& step = steps_[i];
      for (const std::vector<int>* tensors : {&step.node.inputs, &step.node.outputs}) {
        for (const int tensor : *tensors) {
          if (tensor < 0 || needed[size_t(tensor)]) continue;
          needed[size_t(tensor)] = true;
          if (!IsConstant(tensor)) step.last.push_back(tensor);
        }
      }
    }
    for (size_t i = 0; i < constants_.size(); ++i) {
      if (!needed[i]) constants_[i] = GraphTensor();
    }
  }

  void FindFirstOutputs() {
    std::vector<size_t> first(constants_.size(), outputs_.size());
    for (size_t i = outputs_.size(); i-- > 0;) first[size_t(outputs_[i])] = i;
    for (size_t i = steps_.size(); i-- > 0;) {
      Step& step = steps_[i];
      step.first_output = outputs_.size();
      for (const int output : step.node.outputs) {
        if (output >= 0) step.first_output = std::min(step.first_output, first[size_t(output)]);
      }
      for (const int input : step.node.inputs) {
        if (input >= 0) first[size_t(input)] = std::min(first[size_t(input)], step.first_output);
      }
    }
  }

  std::string name_;
  OperatorSettings settings_;
  std::vector<int64_t> input_shape_;
  int input_;
  std::vector<int> outputs_;
  std::vector<std::vector<int64_t>> output_shapes_;
  std::vector<Step> steps_;
  std::vector<GraphTensor> constants_;  ///< by tensor; of those that are computed, and only convolutions read, none
  std::vector<bool> is_constant_;
  std::vector<GraphNode> nodes_;  ///< while steps are made, as the next two
  std::vector<int> uses_;         ///< of each tensor, that are to come
  std::vector<bool> done_;        ///< by the step of a node before
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

GraphExecutor::GraphExecutor(const OperatorGraph& graph, std::vector<int64_t> input_shape,
                             const std::vector<int>& wanted_outputs) {
  BODYLOOM_CHECK(graph.inputs.size() == 1, graph.name, ": ", graph.inputs.size(), " inputs, expected one image");
  const std::vector<int64_t>& stated = graph.tensors[size_t(graph.inputs[0])].shape;
  if (input_shape.empty()) input_shape = stated;
  bool fits = input_shape.size() == stated.size();
  for (size_t i = 0; fits && i < input_shape.size(); ++i) {
    fits = input_shape[i] > 0 && (stated[i] == -1 || stated[i] == input_shape[i]);
  }
  BODYLOOM_CHECK(fits, graph.name, ": an input of ", GraphShapeText(stated), ", wanted ", GraphShapeText(input_shape));
  std::vector<int> wanted;
  for (const int place : wanted_outputs) {
    BODYLOOM_CHECK(place >= 0 && place < int(graph.outputs.size()), graph.name, ": output ", place,
                   " wanted, expected 0 to ", graph.outputs.size() - 1);
    wanted.push_back(graph.outputs[size_t(place)]);
  }
  const OneThread one_thread;
  OperatorGraph arranged = graph;
  arranged.outputs = wanted.empty() ? graph.outputs : wanted;
  arranged = WithChannelsLast(arranged);
  program_ = std::make_shared<const Program>(arranged, std::move(input_shape));
}

const std::vector<int64_t>& GraphExecutor::input_shape() const { return program_->input_shape(); }

const std::vector<std::vector<int64_t>>& GraphExecutor::output_shapes() const { return program_->output_shapes(); }

size_t GraphExecutor::num_steps() const { return program_->num_steps(); }

std::vector<GraphTensor> GraphExecutor::Run(std::vector<float> input, std::optional<int> num_outputs) const {
  BODYLOOM_CHECK(input.size() == GraphShapeSize(program_->input_shape()), program_->name(), ": an input of ",
                 input.size(), " numbers, expected ", GraphShapeText(program_->input_shape()));
  const auto all = int(program_->num_outputs());
  BODYLOOM_CHECK(num_outputs.value_or(all) >= 0 && num_outputs.value_or(all) <= all, program_->name(), ": ",
                 num_outputs.value_or(all), " outputs, expected at most the ", all, " wanted");
  const OneThread one_thread;
  return program_->Run(std::move(input), size_t(num_outputs.value_or(all)));
}

}  // namespace bodyloom
