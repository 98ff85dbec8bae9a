// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/operators.h"

#include <map>
#include <new>
#include <sstream>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

template <GraphTensor (*kOperator)(const OperatorArguments&)>
std::vector<GraphTensor> One(const OperatorArguments& arguments) {
  return {kOperator(arguments)};
}

GraphTensor Same(const OperatorArguments& arguments) { return arguments.Input(0); }

}  // namespace

OperatorFunction FindOperator(const std::string& name) {
  static const std::map<std::string, OperatorFunction> operators = [] {
    const std::pair<const char*, OperatorFunction> known[] = {
        {"Add Sub Mul Div Pow Max Min Equal", One<RunBinary>},
        {"Where", One<RunWhere>},
        {"HardSigmoid HardSwish Relu LeakyRelu Tanh Sqrt Exp Abs Neg Floor Clip", One<RunUnary>},
        {"PRelu", One<RunPRelu>},
        {"ReduceSum ReduceMean ReduceMax ReduceL2", One<RunReduce>},
        {"Softmax", One<RunSoftmax>},
        {"Concat", One<RunConcat>},
        {"Split", RunSplit},
        {"Slice", One<RunSlice>},
        {"Transpose", One<RunTranspose>},
        {"Gather", One<RunGather>},
        {"ScatterND", One<RunScatterNd>},
        {"Reshape Flatten Squeeze Unsqueeze", One<RunReshape>},
        {"Expand", One<RunExpand>},
        {"Tile", One<RunTile>},
        {"Cast", One<RunCast>},
        {"Shape", One<RunShapeOf>},
        {"Constant", One<RunConstant>},
        {"ConstantOfShape", One<RunConstantOfShape>},
        {"Range", One<RunRange>},
        {"Pad", One<RunPad>},
        {"DepthToSpace", One<RunDepthToSpace>},
        {"GlobalAveragePool", One<RunGlobalAveragePool>},
        {"BatchNormalization", One<RunBatchNormalization>},
        {"MatMul", One<RunMatMul>},
        {"Gemm", One<RunGemm>},
        {"Identity Dropout", One<Same>},
    };
    std::map<std::string, OperatorFunction> by_name;
    for (const auto& [names, run] : known) {
      std::istringstream words(names);
      for (std::string word; words >> word;) by_name[word] = run;
    }
    return by_name;
  }();
  const auto found = operators.find(name);
  return found == operators.end() ? nullptr : found->second;
}

std::shared_ptr<float[]> AlignedArray(size_t size) {
  constexpr std::align_val_t kCacheLine{64};
  auto* values = static_cast<float*>(::operator new[](size * sizeof(float) + 1, kCacheLine));
  return {values, [kCacheLine](float* p) { ::operator delete[](p, kCacheLine); }};
}

std::shared_ptr<float[]> FloatPool::Take(size_t size) {
  Array* best = nullptr;
  for (Array& array : arrays_) {
    const bool fits = array.values.use_count() == 1 && array.size >= size;
    if (fits && (best == nullptr || array.size < best->size)) best = &array;
  }
  if (best == nullptr) best = &arrays_.emplace_back(Array{size, AlignedArray(size)});
  return best->values;
}

const GraphTensor& OperatorArguments::Input(size_t i) const {
  if (!Has(i)) throw std::runtime_error(Concatenate("input ", i, " is missing"));
  return *inputs_[i];
}

const GraphTensor& OperatorArguments::FloatInput(size_t i) const {
  const GraphTensor& input = Input(i);
  if (!input.has_floats()) throw std::runtime_error(Concatenate("input ", i, " holds whole numbers, expected floats"));
  return input;
}

const SharedNumbers<int64_t>& OperatorArguments::Ints(size_t i) const {
  const GraphTensor& input = Input(i);
  if (input.has_floats()) throw std::runtime_error(Concatenate("input ", i, " holds floats, expected whole numbers"));
  return input.ints;
}

std::vector<int64_t> OperatorArguments::List(const std::string& attribute, size_t input) const {
  return Has(input) ? Ints(input).Copy() : node_.Integers(attribute, {});
}

float OperatorArguments::Number(const std::string& attribute, size_t input, float absent) const {
  if (!Has(input)) return node_.Float(attribute, absent);
  const SharedNumbers<float>& values = Floats(input);
  if (values.size() != 1)
    throw std::runtime_error(Concatenate("input ", input, ": ", values.size(), " numbers, expected 1"));
  return values[0];
}

int OperatorArguments::Axis(int64_t absent, int rank) const { return AxisAmong(node_.Integer("axis", absent), rank); }

int AxisAmong(int64_t axis, int rank) {
  if (axis < -rank || axis >= rank) throw std::runtime_error(Concatenate("axis ", axis, " of ", rank));
  return int(axis < 0 ? axis + rank : axis);
}

}  // namespace bodyloom
