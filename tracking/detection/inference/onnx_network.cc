// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/onnx_network.h"

#include <algorithm>
#include <dnnl.hpp>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/one_thread.h"
#include "tracking/detection/inference/onnx_arithmetic.h"
#include "tracking/detection/inference/onnx_image.h"
#include "tracking/detection/inference/onnx_products.h"
#include "tracking/detection/inference/onnx_rearrangement.h"

namespace bodyloom {
namespace {

using Operator = std::vector<OnnxTensor> (*)(const OnnxArguments&);

template <OnnxTensor (*kOperator)(const OnnxArguments&)>
std::vector<OnnxTensor> One(const OnnxArguments& arguments) {
  return {kOperator(arguments)};
}

OnnxTensor Same(const OnnxArguments& arguments) { return arguments.Input(0); }

/// By name, but for Conv, which is made once and kept.
const std::map<std::string, Operator>& Operators() {
  static const std::map<std::string, Operator> operators = {
      {"Add", One<OnnxBinary>},
      {"Sub", One<OnnxBinary>},
      {"Mul", One<OnnxBinary>},
      {"Div", One<OnnxBinary>},
      {"Pow", One<OnnxBinary>},
      {"Max", One<OnnxBinary>},
      {"Min", One<OnnxBinary>},
      {"Equal", One<OnnxBinary>},
      {"Where", One<OnnxWhere>},
      {"Sigmoid", One<OnnxUnary>},
      {"HardSigmoid", One<OnnxUnary>},
      {"HardSwish", One<OnnxUnary>},
      {"Relu", One<OnnxUnary>},
      {"LeakyRelu", One<OnnxUnary>},
      {"Tanh", One<OnnxUnary>},
      {"Sqrt", One<OnnxUnary>},
      {"Exp", One<OnnxUnary>},
      {"Abs", One<OnnxUnary>},
      {"Neg", One<OnnxUnary>},
      {"Floor", One<OnnxUnary>},
      {"Clip", One<OnnxUnary>},
      {"ReduceSum", One<OnnxReduce>},
      {"ReduceMean", One<OnnxReduce>},
      {"ReduceMax", One<OnnxReduce>},
      {"ReduceL2", One<OnnxReduce>},
      {"Softmax", One<OnnxSoftmax>},
      {"Concat", One<OnnxConcat>},
      {"Split", OnnxSplit},
      {"Slice", One<OnnxSlice>},
      {"Transpose", One<OnnxTranspose>},
      {"Gather", One<OnnxGather>},
      {"ScatterND", One<OnnxScatterNd>},
      {"Reshape", One<OnnxReshape>},
      {"Flatten", One<OnnxReshape>},
      {"Squeeze", One<OnnxReshape>},
      {"Unsqueeze", One<OnnxReshape>},
      {"Expand", One<OnnxExpand>},
      {"Tile", One<OnnxTile>},
      {"Cast", One<OnnxCast>},
      {"Shape", One<OnnxShapeOf>},
      {"Constant", One<OnnxConstant>},
      {"ConstantOfShape", One<OnnxConstantOfShape>},
      {"Range", One<OnnxRange>},
      {"MaxPool", One<OnnxMaxPool>},
      {"GlobalAveragePool", One<OnnxGlobalAveragePool>},
      {"Resize", One<OnnxEnlarge>},
      {"Upsample", One<OnnxEnlarge>},
      {"BatchNormalization", One<OnnxBatchNormalization>},
      {"MatMul", One<OnnxMatMul>},
      {"Gemm", One<OnnxGemm>},
      {"Identity", One<Same>},
      {"Dropout", One<Same>},
  };
  return operators;
}

/// Whether the two nodes behind a convolution are x · sigmoid(x) of its result, and nobody else reads either.
bool IsSwish(const std::vector<OnnxNode>& nodes, const std::vector<int>& uses, size_t conv, size_t* sigmoid,
             size_t* product) {
  const int x = nodes[conv].outputs.empty() ? -1 : nodes[conv].outputs[0];
  if (x < 0 || uses[size_t(x)] != 2) return false;
  *sigmoid = *product = nodes.size();
  for (size_t i = conv + 1; i < nodes.size(); ++i) {
    const OnnxNode& node = nodes[i];
    if (std::find(node.inputs.begin(), node.inputs.end(), x) == node.inputs.end()) continue;
    if (node.op == "Sigmoid" && node.outputs.size() == 1) *sigmoid = i;
    if (node.op == "Mul" && node.inputs.size() == 2) *product = i;
  }
  if (*sigmoid == nodes.size() || *product == nodes.size()) return false;
  const int s = nodes[*sigmoid].outputs[0];
  const std::vector<int>& factors = nodes[*product].inputs;
  return s >= 0 && uses[size_t(s)] == 1 && std::find(factors.begin(), factors.end(), s) != factors.end();
}

}  // namespace

struct OnnxNetwork::Program {
  /// One thing that runs.
  struct Step {
    OnnxNode node;
    Operator run = nullptr;
    std::optional<OnnxConvolution> convolution;
    std::vector<int> last;  ///< tensors that nobody reads later
  };

  std::string name;
  int64_t opset = 0;
  std::vector<int64_t> input_shape;
  std::vector<Step> steps;
  std::vector<OnnxTensor>
      constants;  ///< by tensor; those that are computed, and what only convolutions read, are empty
  std::vector<bool> is_constant;
  int input = 0;
  std::vector<int> outputs;
  std::vector<std::vector<int64_t>> output_shapes;

  [[noreturn]] void Fail(const OnnxNode& node, const std::string& what) const {
    throw std::runtime_error(name + ": node '" + node.name + "' (" + node.op + "): " + what);
  }

  [[nodiscard]] std::vector<const OnnxTensor*> Inputs(const OnnxNode& node,
                                                      const std::vector<OnnxTensor>& values) const {
    std::vector<const OnnxTensor*> inputs;
    for (const int input : node.inputs) inputs.push_back(input < 0 ? nullptr : &values[size_t(input)]);
    return inputs;
  }

  void Run(const Step& step, std::vector<OnnxTensor>* values) const {
    std::vector<OnnxTensor> results;
    const std::vector<const OnnxTensor*> inputs = Inputs(step.node, *values);
    try {
      if (step.convolution) {
        results = {step.convolution->Run(*inputs.at(0))};
      } else {
        results = step.run(OnnxArguments(step.node, opset, inputs));
      }
    } catch (const dnnl::error& error) {
      Fail(step.node, std::string("oneDNN: ") + error.what());
    } catch (const std::invalid_argument& error) {
      Fail(step.node, error.what());
    } catch (const std::runtime_error& error) {
      Fail(step.node, error.what());
    }
    if (results.size() < step.node.outputs.size()) {
      // Dropout's mask and the like, which nobody reads.
      for (size_t i = results.size(); i < step.node.outputs.size(); ++i) results.emplace_back();
    }
    for (size_t i = 0; i < step.node.outputs.size(); ++i) {
      const int output = step.node.outputs[i];
      if (output >= 0) (*values)[size_t(output)] = std::move(results[i]);
    }
  }

  void MakeConvolution(Step* step, bool swish, const std::vector<OnnxTensor>& values) const {
    for (size_t i = 1; i < step->node.inputs.size(); ++i) {
      const int input = step->node.inputs[i];
      if (input >= 0 && !is_constant[size_t(input)]) Fail(step->node, "weights that are computed, expected constants");
    }
    const std::vector<const OnnxTensor*> inputs = Inputs(step->node, values);
    try {
      step->convolution.emplace(OnnxArguments(step->node, opset, inputs), swish);
    } catch (const dnnl::error& error) {
      Fail(step->node, std::string("oneDNN: ") + error.what());
    } catch (const std::runtime_error& error) {
      Fail(step->node, error.what());
    }
    step->node.inputs.resize(1);
  }

  /// The steps, tried out one after the other on zeros; convolutions are made for the shapes that come along.
  void Build(std::vector<OnnxNode> nodes) {
    std::vector<int> uses(constants.size(), 0);
    for (const OnnxNode& node : nodes) {
      for (const int input : node.inputs) {
        if (input >= 0) ++uses[size_t(input)];
      }
    }
    for (const int output : outputs) ++uses[size_t(output)];
    std::vector<OnnxTensor> values = constants;
    values[size_t(input)] = OnnxTensor(input_shape, std::vector<float>(OnnxShapeSize(input_shape), 0.0F));
    std::vector<char> done(nodes.size(), 0);
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (done[i] != 0) continue;
      Step step;
      size_t sigmoid = 0, product = 0;
      const bool swish = nodes[i].op == "Conv" && IsSwish(nodes, uses, i, &sigmoid, &product);
      step.node = nodes[i];
      if (swish) {
        done[sigmoid] = done[product] = 1;
        step.node.outputs = nodes[product].outputs;
      }
      if (step.node.op == "Conv") {
        MakeConvolution(&step, swish, values);
      } else {
        const auto known = Operators().find(step.node.op);
        if (known == Operators().end()) Fail(step.node, "an operator that is not known here");
        step.run = known->second;
      }
      Run(step, &values);
      for (const int tensor : step.node.inputs) {
        if (tensor >= 0 && --uses[size_t(tensor)] == 0 && !is_constant[size_t(tensor)]) {
          values[size_t(tensor)] = OnnxTensor();
        }
      }
      const bool constant = std::all_of(step.node.inputs.begin(), step.node.inputs.end(),
                                        [this](int tensor) { return tensor < 0 || is_constant[size_t(tensor)]; });
      if (constant) {
        for (const int output : step.node.outputs) {
          if (output < 0) continue;
          is_constant[size_t(output)] = true;
          constants[size_t(output)] = values[size_t(output)];
        }
      } else {
        steps.push_back(std::move(step));
      }
    }
    for (const int output : outputs) {
      const OnnxTensor& tensor = values[size_t(output)];
      if (!tensor.has_floats()) throw std::runtime_error(name + ": an output of whole numbers, expected floats");
      output_shapes.push_back(tensor.shape);
    }
    FindLastUses();
  }

  void FindLastUses() {
    std::vector<bool> needed(constants.size(), false);
    for (const int output : outputs) needed[size_t(output)] = true;
    for (size_t i = steps.size(); i-- > 0;) {
      Step& step = steps[i];
      for (const std::vector<int>* tensors : {&step.node.inputs, &step.node.outputs}) {
        for (const int tensor : *tensors) {
          if (tensor < 0 || needed[size_t(tensor)]) continue;
          needed[size_t(tensor)] = true;
          if (!is_constant[size_t(tensor)]) step.last.push_back(tensor);
        }
      }
    }
    for (size_t i = 0; i < constants.size(); ++i) {
      if (!needed[i]) constants[i] = OnnxTensor();
    }
  }
};

OnnxNetwork::OnnxNetwork(OnnxModel model, std::vector<int64_t> input_shape) {
  BODYLOOM_CHECK(input_shape.size() == model.input_shape.size(), model.name, ": an input of ",
                 OnnxShapeText(model.input_shape), ", wanted ", OnnxShapeText(input_shape));
  for (size_t i = 0; i < input_shape.size(); ++i) {
    BODYLOOM_CHECK(input_shape[i] > 0 && (model.input_shape[i] == -1 || model.input_shape[i] == input_shape[i]),
                   model.name, ": an input of ", OnnxShapeText(model.input_shape), ", wanted ",
                   OnnxShapeText(input_shape));
  }
  const OneThread one_thread;
  auto program = std::make_shared<Program>();
  program->name = model.name;
  program->opset = model.opset;
  program->input_shape = std::move(input_shape);
  program->input = model.input;
  program->outputs = model.outputs;
  program->constants.resize(size_t(model.num_tensors));
  program->is_constant.resize(size_t(model.num_tensors), false);
  for (auto& [tensor, value] : model.constants) {
    program->constants[size_t(tensor)] = std::move(value);
    program->is_constant[size_t(tensor)] = true;
  }
  program->Build(std::move(model.nodes));
  program_ = std::move(program);
}

const std::vector<int64_t>& OnnxNetwork::input_shape() const { return program_->input_shape; }

const std::vector<std::vector<int64_t>>& OnnxNetwork::output_shapes() const { return program_->output_shapes; }

std::vector<OnnxTensor> OnnxNetwork::Run(std::vector<float> input) const {
  const Program& program = *program_;
  BODYLOOM_CHECK(input.size() == OnnxShapeSize(program.input_shape), program.name, ": an input of ", input.size(),
                 " numbers, expected ", OnnxShapeText(program.input_shape));
  const OneThread one_thread;
  std::vector<OnnxTensor> values = program.constants;
  values[size_t(program.input)] = OnnxTensor(program.input_shape, std::move(input));
  for (const Program::Step& step : program.steps) {
    program.Run(step, &values);
    for (const int tensor : step.last) values[size_t(tensor)] = OnnxTensor();
  }
  std::vector<OnnxTensor> outputs;
  for (const int output : program.outputs) outputs.push_back(std::move(values[size_t(output)]));
  return outputs;
}

}  // namespace bodyloom
