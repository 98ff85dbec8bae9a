// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/operators.h"

namespace bodyloom {
namespace {

size_t Product(const std::vector<int64_t>& shape, size_t from, size_t to) {
  return GraphShapeSize({shape.begin() + std::ptrdiff_t(from), shape.begin() + std::ptrdiff_t(to)});
}

/// Calls move(input's numbers, result's numbers) with the element type of the tensor.
template <typename Move>
GraphTensor Moved(const OperatorArguments& arguments, const GraphTensor& tensor, const std::vector<int64_t>& shape,
                  const Move& move) {
  const auto moved = [&]<typename T>(const SharedNumbers<T>& from) {
    const NewNumbers<T> to = arguments.New<T>(GraphShapeSize(shape));
    move(from.data(), to.data());
    return GraphTensor(shape, to);
  };
  return tensor.has_floats() ? moved(tensor.floats) : moved(tensor.ints);
}

/// The numbers at the indices `places` of the input, in that order.
GraphTensor Picked(const OperatorArguments& arguments, const GraphTensor& tensor, const std::vector<int64_t>& shape,
                   const std::vector<size_t>& places) {
  return Moved(arguments, tensor, shape, [&places](const auto* from, auto* to) {
    for (const size_t place : places) *to++ = from[place];
  });
}

/// The `count` entries from `begin` on along one axis.
GraphTensor Part(const OperatorArguments& arguments, const GraphTensor& tensor, int axis, int64_t begin,
                 int64_t count) {
  std::vector<int64_t> shape = tensor.shape;
  const size_t before = Product(shape, 0, size_t(axis)), behind = Product(shape, size_t(axis) + 1, shape.size());
  const size_t from_row = size_t(shape[size_t(axis)]) * behind, row = size_t(count) * behind;
  shape[size_t(axis)] = count;
  return Moved(arguments, tensor, shape, [&](const auto* from, auto* to) {
    for (size_t i = 0; i < before; ++i) std::copy_n(from + i * from_row + size_t(begin) * behind, row, to + i * row);
  });
}

/// Begin, step and number of entries of a slice of one axis.
struct Taken {
  int64_t begin = 0, step = 1, count = 0;
};

Taken SliceOf(int64_t begin, int64_t end, int64_t step, int64_t length) {
  if (step == 0 || step == std::numeric_limits<int64_t>::min())
    throw std::runtime_error(Concatenate("a slice in steps of ", step));
  const auto limited = [length](int64_t at, int64_t low, int64_t high) {
    return std::clamp(at < 0 ? std::max(at, -length - 1) + length : at, low, high);
  };
  if (step > 0) {
    begin = limited(begin, 0, length);
    end = limited(end, 0, length);
    return {begin, step, end > begin ? (end - begin - 1) / step + 1 : 0};
  }
  begin = limited(begin, -1, length - 1);
  end = limited(end, -1, length - 1);
  return {begin, step, begin > end ? (begin - end - 1) / -step + 1 : 0};
}

GraphTensor Sliced(const OperatorArguments& arguments, const GraphTensor& tensor, int axis, const Taken& taken) {
  if (taken.step == 1) return Part(arguments, tensor, axis, taken.begin, taken.count);
  std::vector<int64_t> shape = tensor.shape;
  const size_t before = Product(shape, 0, size_t(axis)), behind = Product(shape, size_t(axis) + 1, shape.size());
  const auto length = size_t(shape[size_t(axis)]);
  shape[size_t(axis)] = taken.count;
  std::vector<size_t> places;
  for (size_t i = 0; i < before; ++i) {
    for (int64_t k = 0; k < taken.count; ++k) {
      const size_t row = i * length + size_t(taken.begin + k * taken.step);
      for (size_t j = 0; j < behind; ++j) places.push_back(row * behind + j);
    }
  }
  return Picked(arguments, tensor, shape, places);
}

int64_t Found(int64_t index, int64_t length) {
  if (index < -length || index >= length)
    throw std::runtime_error(Concatenate("entry ", index, " of an axis of ", length));
  return index < 0 ? index + length : index;
}

std::vector<int64_t> ShapeFor(const GraphTensor& tensor, std::vector<int64_t> wanted, bool keep_zeros) {
  int64_t known = 1, open = -1;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == 0 && !keep_zeros && i < tensor.shape.size()) wanted[i] = tensor.shape[i];
    if (wanted[i] == -1) {
      if (open >= 0) throw std::runtime_error(GraphShapeText(wanted) + " leaves two axes open");
      open = int64_t(i);
    }
  }
  for (const int64_t n : wanted) {
    if (n != -1) known = int64_t(GraphShapeSize({known, n}));
  }
  const auto size = int64_t(tensor.size());
  if (open >= 0 && known > 0 && size % known == 0) wanted[size_t(open)] = size / known;
  if (std::count(wanted.begin(), wanted.end(), -1) > 0 || int64_t(GraphShapeSize(wanted)) != size) {
    throw std::runtime_error(GraphShapeText(tensor.shape) + " cannot become " + GraphShapeText(wanted));
  }
  return wanted;
}

std::vector<int64_t> Squeezed(const std::vector<int64_t>& shape, const std::vector<int64_t>& axes) {
  std::vector<bool> gone(shape.size(), false);
  for (const int64_t axis : axes) gone[size_t(AxisAmong(axis, int(shape.size())))] = true;
  std::vector<int64_t> result;
  for (size_t i = 0; i < shape.size(); ++i) {
    if (axes.empty() ? shape[i] == 1 : bool(gone[i])) {
      if (shape[i] != 1) throw std::runtime_error(Concatenate("axis ", i, " of ", GraphShapeText(shape), " is no 1"));
      continue;
    }
    result.push_back(shape[i]);
  }
  return result;
}

std::vector<int64_t> Unsqueezed(const std::vector<int64_t>& shape, const std::vector<int64_t>& axes) {
  const size_t rank = shape.size() + axes.size();
  std::vector<bool> is_new(rank, false);
  for (const int64_t axis : axes) is_new[size_t(AxisAmong(axis, int(rank)))] = true;
  if (size_t(std::count(is_new.begin(), is_new.end(), true)) != axes.size())
    throw std::runtime_error("an axis is named twice");
  std::vector<int64_t> result;
  size_t next = 0;
  for (size_t i = 0; i < rank; ++i) result.push_back(is_new[i] ? 1 : shape[next++]);
  return result;
}

}  // namespace

GraphTensor RunConcat(const OperatorArguments& arguments) {
  const GraphTensor& first = arguments.Input(0);
  const int axis = arguments.Axis(1, first.rank());
  std::vector<int64_t> shape = first.shape;
  shape[size_t(axis)] = 0;
  for (size_t i = 0; i < arguments.num_inputs(); ++i) {
    std::vector<int64_t> other = arguments.Input(i).shape;
    if (other.size() != shape.size() || arguments.Input(i).has_floats() != first.has_floats()) {
      throw std::runtime_error("tensors of different ranks or kinds side by side");
    }
    std::swap(other[size_t(axis)], shape[size_t(axis)]);
    if (!std::equal(shape.begin(), shape.begin() + axis, other.begin()) ||
        !std::equal(shape.begin() + axis + 1, shape.end(), other.begin() + axis + 1)) {
      throw std::runtime_error(GraphShapeText(arguments.Input(i).shape) + " beside " + GraphShapeText(first.shape));
    }
    shape[size_t(axis)] += other[size_t(axis)];
  }
  const size_t before = Product(shape, 0, size_t(axis)), behind = Product(shape, size_t(axis), shape.size());
  size_t start = 0;
  const auto join = [&](const auto* from, size_t size, auto* to) {
    const size_t row = before == 0 ? 0 : size / before;
    for (size_t r = 0; r < before; ++r) std::copy_n(from + r * row, row, to + r * behind + start);
    start += row;
  };
  return Moved(arguments, first, shape, [&]<typename T>(const T* /*first*/, T* to) {
    for (size_t i = 0; i < arguments.num_inputs(); ++i) {
      if constexpr (std::is_same_v<T, float>) {
        join(arguments.Floats(i).data(), arguments.Floats(i).size(), to);
      } else {
        join(arguments.Ints(i).data(), arguments.Ints(i).size(), to);
      }
    }
  });
}

std::vector<GraphTensor> RunSplit(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.Input(0);
  const int axis = arguments.Axis(0, input.rank());
  const int64_t length = input.shape[size_t(axis)];
  std::vector<int64_t> parts = arguments.List("split", 1);
  if (parts.empty()) {
    const auto count = int64_t(arguments.node().outputs.size());
    const int64_t each = count > 0 ? (length + count - 1) / count : 0;  // the last one is smaller
    for (int64_t i = 0; i < count; ++i) parts.push_back(std::clamp<int64_t>(length - i * each, 0, each));
  }
  int64_t begin = 0;
  std::vector<GraphTensor> result;
  for (const int64_t part : parts) {
    if (part < 0 || part > length - begin)
      throw std::runtime_error(Concatenate("parts of an axis of ", length, " that do not fit it"));
    result.push_back(Part(arguments, input, axis, begin, part));
    begin += part;
  }
  if (begin != length) throw std::runtime_error(Concatenate("parts of ", begin, " for an axis of ", length));
  return result;
}

GraphTensor RunSlice(const OperatorArguments& arguments) {
  GraphTensor result = arguments.Input(0);
  const std::vector<int64_t> begins = arguments.List("starts", 1), ends = arguments.List("ends", 2);
  std::vector<int64_t> axes = arguments.List("axes", 3), steps = arguments.List("", 4);
  for (size_t i = axes.size(); axes.size() < begins.size(); ++i) axes.push_back(int64_t(i));
  steps.resize(std::max(steps.size(), begins.size()), 1);
  if (ends.size() != begins.size() || axes.size() != begins.size() || steps.size() != begins.size()) {
    throw std::runtime_error("starts, ends, axes and steps of different numbers");
  }
  for (size_t i = 0; i < begins.size(); ++i) {
    const int axis = AxisAmong(axes[i], result.rank());
    result = Sliced(arguments, result, axis, SliceOf(begins[i], ends[i], steps[i], result.shape[size_t(axis)]));
  }
  return result;
}

std::vector<int64_t> TransposedAxes(const OperatorArguments& arguments) {
  const auto rank = size_t(arguments.Input(0).rank());
  std::vector<int64_t> order;
  for (size_t i = rank; i-- > 0;) order.push_back(int64_t(i));
  order = arguments.node().Integers("perm", order);
  std::vector<int64_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 0; i < sorted.size(); ++i) {
    if (sorted.size() != rank || sorted[i] != int64_t(i)) throw std::runtime_error("an order that is none of the axes");
  }
  return order;
}

GraphTensor RunTranspose(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.Input(0);
  const auto rank = size_t(input.rank());
  const std::vector<int64_t> order = TransposedAxes(arguments);
  std::vector<size_t> stride(rank, 1);
  for (size_t i = rank; i-- > 1;) stride[i - 1] = stride[i] * size_t(input.shape[i]);
  std::vector<int64_t> shape;
  shape.reserve(rank);
  for (const int64_t axis : order) shape.push_back(input.shape[size_t(axis)]);
  std::vector<size_t> places(input.size());
  std::vector<int64_t> at(rank, 0);
  size_t place = 0;
  for (size_t& to : places) {
    to = place;
    for (size_t i = rank; i-- > 0;) {
      const size_t step = stride[size_t(order[i])];
      place += step;
      if (++at[i] < shape[i]) break;
      place -= step * size_t(shape[i]);
      at[i] = 0;
    }
  }
  return Picked(arguments, input, shape, places);
}

GraphTensor RunGather(const OperatorArguments& arguments) {
  const GraphTensor &input = arguments.Input(0), &index = arguments.Input(1);
  const int axis = arguments.Axis(0, input.rank());
  const SharedNumbers<int64_t>& wanted = arguments.Ints(1);
  const size_t before = Product(input.shape, 0, size_t(axis)),
               behind = Product(input.shape, size_t(axis) + 1, input.shape.size());
  const int64_t length = input.shape[size_t(axis)];
  std::vector<int64_t> shape(input.shape.begin(), input.shape.begin() + axis);
  shape.insert(shape.end(), index.shape.begin(), index.shape.end());
  shape.insert(shape.end(), input.shape.begin() + axis + 1, input.shape.end());
  std::vector<size_t> places;
  places.reserve(GraphShapeSize(shape));
  for (size_t i = 0; i < before; ++i) {
    for (const int64_t entry : wanted) {
      const size_t row = i * size_t(length) + size_t(Found(entry, length));
      for (size_t j = 0; j < behind; ++j) places.push_back(row * behind + j);
    }
  }
  return Picked(arguments, input, shape, places);
}

GraphTensor RunScatterNd(const OperatorArguments& arguments) {
  const GraphTensor &input = arguments.Input(0), &index = arguments.Input(1);
  const SharedNumbers<int64_t>& places = arguments.Ints(1);
  if (index.rank() == 0 || index.shape.back() < 1 || index.shape.back() > input.rank()) {
    throw std::runtime_error("places of " + GraphShapeText(index.shape));
  }
  const auto depth = size_t(index.shape.back());
  const size_t row = Product(input.shape, depth, input.shape.size()), count = places.size() / depth;
  std::vector<float> values = arguments.Floats(0).Copy();
  const SharedNumbers<float>& updates = arguments.Floats(2);
  if (updates.size() != count * row)
    throw std::runtime_error(Concatenate(updates.size(), " values, expected ", count * row));
  for (size_t i = 0; i < count; ++i) {
    size_t at = 0;
    for (size_t k = 0; k < depth; ++k) {
      at = at * size_t(input.shape[k]) + size_t(Found(places[i * depth + k], input.shape[k]));
    }
    std::copy_n(updates.begin() + i * row, row, values.begin() + std::ptrdiff_t(at * row));
  }
  return {input.shape, std::move(values)};
}

GraphTensor RunReshape(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.Input(0);
  const std::string& op = arguments.node().op;
  if (op == "Squeeze") return input.Reshaped(Squeezed(input.shape, arguments.List("axes", 1)));
  if (op == "Unsqueeze") return input.Reshaped(Unsqueezed(input.shape, arguments.List("axes", 1)));
  if (op == "Flatten") {
    const int64_t axis = arguments.node().Integer("axis", 1);
    const size_t at = axis == input.rank() ? size_t(axis) : size_t(AxisAmong(axis, input.rank()));
    return input.Reshaped(
        {int64_t(Product(input.shape, 0, at)), int64_t(Product(input.shape, at, input.shape.size()))});
  }
  return input.Reshaped(ShapeFor(input, arguments.List("shape", 1), arguments.node().Integer("allowzero", 0) != 0));
}

GraphTensor RunExpand(const OperatorArguments& arguments) {
  return BroadcastTo(arguments.Input(0), BroadcastShape(arguments.Input(0).shape, arguments.Ints(1).Copy()));
}

GraphTensor RunTile(const OperatorArguments& arguments) {
  GraphTensor result = arguments.Input(0);
  const SharedNumbers<int64_t>& times = arguments.Ints(1);
  if (int(times.size()) != result.rank())
    throw std::runtime_error(Concatenate(times.size(), " numbers for ", result.rank(), " axes"));
  for (size_t axis = 0; axis < times.size(); ++axis) {
    std::vector<int64_t> shape = result.shape;
    shape.insert(shape.begin() + std::ptrdiff_t(axis), 1);
    const GraphTensor open = result.Reshaped(shape);
    shape[axis] = times[axis];
    GraphShapeSize(shape);
    result.shape[axis] *= times[axis];
    result = BroadcastTo(open, shape).Reshaped(result.shape);
  }
  return result;
}

GraphTensor RunCast(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.Input(0);
  const int64_t type = arguments.node().Integer("to", 0);
  const bool to_floats = type == 1 || type == 10 || type == 11;
  if (!to_floats && type != 6 && type != 7 && type != 9) {
    throw std::runtime_error(
        Concatenate("numbers of type ", type, ", expected float32, float16, int32, int64 or bool"));
  }
  if (to_floats && !input.has_floats()) {
    return {input.shape, std::vector<float>(input.ints.begin(), input.ints.end())};
  }
  if (to_floats) return input;
  std::vector<int64_t> values;
  if (!input.has_floats()) {
    values = input.ints.Copy();
  } else {
    for (const float value : input.floats) {
      if (!(std::abs(value) < 9e18F)) throw std::runtime_error("a number too large to be whole");
      values.push_back(type == 9 ? int64_t(value != 0) : int64_t(value));
    }
  }
  for (int64_t& value : values) {
    if (type == 9) value = value != 0 ? 1 : 0;
  }
  return {input.shape, std::move(values)};
}

GraphTensor RunShapeOf(const OperatorArguments& arguments) {
  const std::vector<int64_t> shape = arguments.Input(0).shape;
  const auto rank = int64_t(shape.size());
  const auto limited = [rank](int64_t at) { return std::clamp<int64_t>(at < 0 ? at + rank : at, 0, rank); };
  const int64_t begin = limited(arguments.node().Integer("start", 0)),
                end = std::max(begin, limited(arguments.node().Integer("end", rank)));
  return {{end - begin}, std::vector<int64_t>(shape.begin() + begin, shape.begin() + end)};
}

GraphTensor RunConstant(const OperatorArguments& arguments) {
  const std::map<std::string, GraphAttribute>& attributes = arguments.node().attributes;
  const auto value = [&attributes](const char* name) {
    const auto at = attributes.find(name);
    return at == attributes.end() ? nullptr : &at->second;
  };
  if (const GraphAttribute* tensor = value("value"); tensor && tensor->tensor.has_numbers()) {
    return tensor->tensor;
  }
  if (const GraphAttribute* number = value("value_float"); number && number->floats.size() == 1) {
    return {{}, number->floats};
  }
  if (const GraphAttribute* number = value("value_int"); number && number->ints.size() == 1) return {{}, number->ints};
  if (const GraphAttribute* list = value("value_floats")) return {{int64_t(list->floats.size())}, list->floats};
  if (const GraphAttribute* list = value("value_ints")) return {{int64_t(list->ints.size())}, list->ints};
  throw std::runtime_error("a constant without numbers");
}

GraphTensor RunConstantOfShape(const OperatorArguments& arguments) {
  const std::vector<int64_t> shape = arguments.Ints(0).Copy();
  const size_t size = GraphShapeSize(shape);
  if (!arguments.node().Has("value")) return {shape, std::vector<float>(size, 0.0F)};
  const GraphTensor value = RunConstant(arguments);
  if (value.size() != 1) throw std::runtime_error(Concatenate(value.size(), " numbers, expected 1"));
  if (value.has_floats()) return {shape, std::vector<float>(size, value.floats[0])};
  return {shape, std::vector<int64_t>(size, value.ints[0])};
}

GraphTensor RunRange(const OperatorArguments& arguments) {
  const auto range = []<typename T>(const SharedNumbers<T>& begin, const SharedNumbers<T>& end,
                                    const SharedNumbers<T>& step) {
    if (begin.size() != 1 || end.size() != 1 || step.size() != 1 || step[0] == 0)
      throw std::runtime_error("a range without an end");
    const double count = std::ceil((double(end[0]) - double(begin[0])) / double(step[0]));
    const size_t size = GraphShapeSize({count > 0 ? int64_t(std::min(count, 1e12)) : 0});
    std::vector<T> values(size);
    for (size_t i = 0; i < size; ++i) values[i] = i == 0 ? begin[0] : T(values[i - 1] + step[0]);
    return GraphTensor({int64_t(size)}, std::move(values));
  };
  if (arguments.Input(0).has_floats()) return range(arguments.Floats(0), arguments.Floats(1), arguments.Floats(2));
  return range(arguments.Ints(0), arguments.Ints(1), arguments.Ints(2));
}

}  // namespace bodyloom
