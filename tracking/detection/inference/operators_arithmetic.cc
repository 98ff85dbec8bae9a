// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/operators.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// For each number of the result, calls body(place, its place in `from`): `from` is broadcast to `shape`.
template <typename Body>
void ForBroadcast(const std::vector<int64_t>& from, const std::vector<int64_t>& shape, const Body& body) {
  const size_t rank = shape.size(), size = GraphShapeSize(shape);
  std::vector<size_t> step(rank, 0);  // in `from`, along each axis of `shape`
  size_t stride = 1;
  for (size_t i = from.size(); i-- > 0;) {
    if (from[i] != 1) step[rank - from.size() + i] = stride;
    stride *= size_t(from[i]);
  }
  if (size == 0) return;
  if (rank == 0) {
    body(0, 0);
    return;
  }
  const auto row = size_t(shape.back());
  std::vector<int64_t> at(rank, 0);
  size_t start = 0;
  for (size_t place = 0; place < size; place += row) {
    for (size_t i = 0; i < row; ++i) body(place + i, start + i * step.back());
    for (size_t axis = rank - 1; axis-- > 0;) {
      start += step[axis];
      if (++at[axis] < shape[axis]) break;
      start -= step[axis] * size_t(shape[axis]);
      at[axis] = 0;
    }
  }
}

template <typename T>
std::vector<T> Broadcast(const SharedNumbers<T>& values, const std::vector<int64_t>& from,
                         const std::vector<int64_t>& to) {
  std::vector<T> result(GraphShapeSize(to));
  ForBroadcast(from, to, [&](size_t place, size_t source) { result[place] = values[source]; });
  return result;
}

/// Two tensors' numbers of one kind, and the shape that both are broadcast to.
template <typename T>
struct Operands {
  const SharedNumbers<T>&a, &b;
  const std::vector<int64_t>&a_shape, &b_shape, &shape;
};

/// Writes compute(a, b) of each pair of the broadcast operands.
template <typename T, typename Compute>
void Combine(const Operands<T>& operands, const NewNumbers<T>& result, const Compute& compute) {
  // By names of their own: clang 14 has no lambda that captures a structured binding.
  const auto &a = operands.a, &b = operands.b;
  const std::vector<int64_t>&a_shape = operands.a_shape, &b_shape = operands.b_shape, &shape = operands.shape;
  if (a_shape == shape && b_shape == shape) {
    for (size_t i = 0; i < result.size(); ++i) result[i] = compute(a[i], b[i]);
  } else if (a_shape == shape) {
    ForBroadcast(b_shape, shape, [&](size_t place, size_t source) { result[place] = compute(a[place], b[source]); });
  } else {
    ForBroadcast(a_shape, shape, [&](size_t place, size_t source) { result[place] = a[source]; });
    ForBroadcast(b_shape, shape,
                 [&](size_t place, size_t source) { result[place] = compute(result[place], b[source]); });
  }
}

/// Whole numbers wrap around, since those of a file may be arbitrarily large.
int64_t Wrapped(uint64_t value) { return int64_t(value); }

int64_t Divided(int64_t a, int64_t b) {
  if (b == 0) throw std::runtime_error("division by zero");
  return b == -1 ? Wrapped(0 - uint64_t(a)) : a / b;
}

template <typename T>
T Computed(char op, T a, T b) {
  constexpr bool kWhole = std::is_integral_v<T>;
  switch (op) {
    case '+':
      if constexpr (kWhole) return Wrapped(uint64_t(a) + uint64_t(b));
      return a + b;
    case '-':
      if constexpr (kWhole) return Wrapped(uint64_t(a) - uint64_t(b));
      return a - b;
    case '*':
      if constexpr (kWhole) return Wrapped(uint64_t(a) * uint64_t(b));
      return a * b;
    case '/':
      if constexpr (kWhole) return Divided(a, b);
      return a / b;
    case '^':
      if constexpr (kWhole) throw std::runtime_error("a power of whole numbers, expected floats");
      return b == T(2) ? a * a : std::pow(a, b);
    case '<':
      return std::min(a, b);
    default:
      return std::max(a, b);
  }
}

/// Dispatches on the operator once, not for every number.
template <typename T>
void Combine(char op, const Operands<T>& operands, const NewNumbers<T>& result) {
  const auto with = [&]<char kOp>() { Combine(operands, result, [](T x, T y) { return Computed<T>(kOp, x, y); }); };
  switch (op) {
    case '+':
      return with.template operator()<'+'>();
    case '-':
      return with.template operator()<'-'>();
    case '*':
      return with.template operator()<'*'>();
    case '/':
      return with.template operator()<'/'>();
    case '^':
      return with.template operator()<'^'>();
    case '<':
      return with.template operator()<'<'>();
    default:
      return with.template operator()<'>'>();
  }
}

char Letter(const std::string& op) {
  if (op == "Add") return '+';
  if (op == "Sub") return '-';
  if (op == "Mul") return '*';
  if (op == "Div") return '/';
  if (op == "Pow") return '^';
  return op == "Min" ? '<' : '>';
}

void RequireAlike(const GraphTensor& a, const GraphTensor& b) {
  if (a.has_floats() != b.has_floats()) throw std::runtime_error("floats and whole numbers, expected one kind");
}

template <typename T>
std::vector<int64_t> EqualPlaces(const SharedNumbers<T>& a, const SharedNumbers<T>& b) {
  std::vector<int64_t> equal(a.size());
  for (size_t i = 0; i < a.size(); ++i) equal[i] = a[i] == b[i] ? 1 : 0;
  return equal;
}

GraphTensor Equal(const GraphTensor& a, const GraphTensor& b, std::vector<int64_t> shape) {
  const GraphTensor x = BroadcastTo(a, shape), y = BroadcastTo(b, shape);
  std::vector<int64_t> equal = a.has_floats() ? EqualPlaces(x.floats, y.floats) : EqualPlaces(x.ints, y.ints);
  return {std::move(shape), std::move(equal)};
}

template <typename Compute>
GraphTensor Mapped(const OperatorArguments& arguments, const Compute& compute) {
  const SharedNumbers<float>& from = arguments.Floats(0);
  const NewNumbers<float> to = arguments.New<float>(from.size());
  std::transform(from.begin(), from.end(), to.begin(), compute);
  return {arguments.Input(0).shape, to};
}

/// Numbers before, along and behind an axis: the tensor is before × along × behind.
struct Split {
  size_t before = 1, along = 1, behind = 1;
  Split(const std::vector<int64_t>& shape, int axis) {
    for (int i = 0; i < int(shape.size()); ++i) {
      (i < axis ? before : i == axis ? along : behind) *= size_t(shape[size_t(i)]);
    }
  }
};

/// Σ, Σ² or the maximum along one axis, which stays with length 1.
GraphTensor ReducedAlong(const GraphTensor& tensor, int axis, char what) {
  const Split n(tensor.shape, axis);
  std::vector<int64_t> shape = tensor.shape;
  shape[size_t(axis)] = 1;
  std::vector<float> result(n.before * n.behind, what == '>' ? -std::numeric_limits<float>::infinity() : 0.0F);
  const float* from = tensor.floats.data();
  for (size_t i = 0; i < n.before; ++i) {
    for (size_t k = 0; k < n.along; ++k) {
      float* to = result.data() + i * n.behind;
      for (size_t j = 0; j < n.behind; ++j, ++from) {
        to[j] = what == '>' ? std::max(to[j], *from) : to[j] + *from;
      }
    }
  }
  return {std::move(shape), std::move(result)};
}

}  // namespace

std::vector<int64_t> BroadcastShape(const std::vector<int64_t>& a, const std::vector<int64_t>& b) {
  const size_t rank = std::max(a.size(), b.size());
  std::vector<int64_t> shape(rank, 1);
  for (size_t i = 0; i < rank; ++i) {
    const int64_t n = i < rank - a.size() ? 1 : a[i - (rank - a.size())];
    const int64_t m = i < rank - b.size() ? 1 : b[i - (rank - b.size())];
    if (n != m && n != 1 && m != 1) {
      throw std::runtime_error("shapes " + GraphShapeText(a) + " and " + GraphShapeText(b) + " do not fit each other");
    }
    shape[i] = n == 1 ? m : n;
  }
  return shape;
}

GraphTensor BroadcastTo(const GraphTensor& tensor, const std::vector<int64_t>& shape) {
  if (tensor.shape == shape) return tensor;
  if (BroadcastShape(tensor.shape, shape) != shape) {
    throw std::runtime_error(GraphShapeText(tensor.shape) + " cannot be broadcast to " + GraphShapeText(shape));
  }
  if (tensor.has_floats()) return {shape, Broadcast(tensor.floats, tensor.shape, shape)};
  return {shape, Broadcast(tensor.ints, tensor.shape, shape)};
}

GraphTensor RunBinary(const OperatorArguments& arguments) {
  const GraphTensor& a = arguments.Input(0);
  GraphTensor b = arguments.Input(1);
  if (arguments.node().op == "Pow" && a.has_floats() && !b.has_floats()) {
    b = GraphTensor(b.shape, std::vector<float>(b.ints.begin(), b.ints.end()));
  }
  RequireAlike(a, b);
  std::vector<int64_t> shape = BroadcastShape(a.shape, b.shape);
  if (arguments.node().op == "Equal") return Equal(a, b, std::move(shape));
  const char op = Letter(arguments.node().op);
  const auto combined = [&]<typename T>(const SharedNumbers<T>& of_a, const SharedNumbers<T>& of_b) {
    const NewNumbers<T> result = arguments.New<T>(GraphShapeSize(shape));
    Combine(op, Operands<T>{of_a, of_b, a.shape, b.shape, shape}, result);
    return GraphTensor(shape, result);
  };
  return a.has_floats() ? combined(a.floats, b.floats) : combined(a.ints, b.ints);
}

GraphTensor RunWhere(const OperatorArguments& arguments) {
  RequireAlike(arguments.Input(1), arguments.Input(2));
  const std::vector<int64_t> shape =
      BroadcastShape(arguments.Input(0).shape, BroadcastShape(arguments.Input(1).shape, arguments.Input(2).shape));
  const GraphTensor condition = BroadcastTo(GraphTensor(arguments.Input(0).shape, arguments.Ints(0)), shape);
  const GraphTensor yes = BroadcastTo(arguments.Input(1), shape), no = BroadcastTo(arguments.Input(2), shape);
  const auto chosen = [&]<typename T>(const SharedNumbers<T>& of_yes, const SharedNumbers<T>& of_no) {
    const NewNumbers<T> result = arguments.New<T>(of_yes.size());
    for (size_t i = 0; i < result.size(); ++i) result[i] = condition.ints[i] != 0 ? of_yes[i] : of_no[i];
    return GraphTensor(shape, result);
  };
  return yes.has_floats() ? chosen(yes.floats, no.floats) : chosen(yes.ints, no.ints);
}

std::pair<float, float> ClipBounds(const OperatorArguments& arguments) {
  constexpr float kMaximum = std::numeric_limits<float>::max();
  return {arguments.Number("min", 1, -kMaximum), arguments.Number("max", 2, kMaximum)};
}

GraphTensor RunUnary(const OperatorArguments& arguments) {
  const std::string& op = arguments.node().op;
  if (op == "Neg" && !arguments.Input(0).has_floats()) {
    std::vector<int64_t> values = arguments.Ints(0).Copy();
    for (int64_t& value : values) value = Wrapped(0 - uint64_t(value));
    return {arguments.Input(0).shape, std::move(values)};
  }
  if (op == "Relu") return Mapped(arguments, [](float x) { return std::max(x, 0.0F); });
  if (op == "Tanh") return Mapped(arguments, [](float x) { return std::tanh(x); });
  if (op == "Sqrt") return Mapped(arguments, [](float x) { return std::sqrt(x); });
  if (op == "Exp") return Mapped(arguments, [](float x) { return std::exp(x); });
  if (op == "Abs") return Mapped(arguments, [](float x) { return std::abs(x); });
  if (op == "Neg") return Mapped(arguments, [](float x) { return -x; });
  if (op == "Floor") return Mapped(arguments, [](float x) { return std::floor(x); });
  if (op == "HardSwish") return Mapped(arguments, [](float x) { return x * std::clamp(x / 6 + 0.5F, 0.0F, 1.0F); });
  if (op == "LeakyRelu") {
    const float slope = arguments.node().Float("alpha", 0.01F);
    return Mapped(arguments, [slope](float x) { return x < 0 ? slope * x : x; });
  }
  if (op == "HardSigmoid") {
    const float alpha = arguments.node().Float("alpha", 0.2F), beta = arguments.node().Float("beta", 0.5F);
    return Mapped(arguments, [=](float x) { return std::clamp(alpha * x + beta, 0.0F, 1.0F); });
  }
  return Mapped(arguments, [bounds = ClipBounds(arguments)](float x) {
    return std::min(std::max(x, bounds.first), bounds.second);
  });
}

GraphTensor RunPRelu(const OperatorArguments& arguments) {
  const GraphTensor &x = arguments.FloatInput(0), &slopes = arguments.FloatInput(1);
  if (BroadcastShape(x.shape, slopes.shape) != x.shape) {
    throw std::runtime_error("slopes of " + GraphShapeText(slopes.shape) + " for " + GraphShapeText(x.shape));
  }
  const NewNumbers<float> result = arguments.New<float>(x.size());
  Combine(Operands<float>{x.floats, slopes.floats, x.shape, slopes.shape, x.shape}, result,
          [](float value, float slope) { return std::max(value, 0.0F) + slope * std::min(value, 0.0F); });
  return {x.shape, result};
}

GraphTensor RunReduce(const OperatorArguments& arguments) {
  const std::string& op = arguments.node().op;
  GraphTensor result = arguments.FloatInput(0);
  const int rank = result.rank();
  std::vector<int64_t> axes = arguments.List("axes", 1);
  if (axes.empty()) {
    for (int axis = 0; axis < rank; ++axis) axes.push_back(axis);
  }
  if (op == "ReduceL2") result = Mapped(arguments, [](float x) { return x * x; });
  size_t count = 1;
  std::vector<bool> gone(size_t(rank), false);
  for (const int64_t named : axes) {
    const int axis = AxisAmong(named, rank);
    count *= size_t(result.shape[size_t(axis)]);
    result = ReducedAlong(result, axis, op == "ReduceMax" ? '>' : '+');
    gone[size_t(axis)] = true;
  }
  std::vector<float> values = result.floats.Copy();
  for (float& value : values) {
    if (op == "ReduceMean") value /= float(count);
    if (op == "ReduceL2") value = std::sqrt(value);
  }
  std::vector<int64_t> shape;
  for (int axis = 0; axis < rank; ++axis) {
    if (arguments.node().Integer("keepdims", 1) != 0 || !gone[size_t(axis)])
      shape.push_back(result.shape[size_t(axis)]);
  }
  return {std::move(shape), std::move(values)};
}

GraphTensor RunSoftmax(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.Input(0);
  std::vector<float> values = arguments.Floats(0).Copy();
  const Split n(input.shape, arguments.Axis(arguments.opset() < 13 ? 1 : -1, input.rank()));
  if (arguments.opset() < 13 && n.behind > 1) {
    throw std::runtime_error("a softmax over several axes, expected over the last");
  }
  std::vector<float> largest(n.behind), sum(n.behind);
  for (size_t i = 0; i < n.before; ++i) {
    float* block = values.data() + i * n.along * n.behind;
    std::fill(largest.begin(), largest.end(), -std::numeric_limits<float>::infinity());
    std::fill(sum.begin(), sum.end(), 0.0F);
    for (size_t k = 0; k < n.along * n.behind; ++k) largest[k % n.behind] = std::max(largest[k % n.behind], block[k]);
    for (size_t k = 0; k < n.along * n.behind; ++k) {
      block[k] = std::exp(block[k] - largest[k % n.behind]);
      sum[k % n.behind] += block[k];
    }
    for (size_t k = 0; k < n.along * n.behind; ++k) block[k] /= sum[k % n.behind];
  }
  return {input.shape, std::move(values)};
}

}  // namespace bodyloom
