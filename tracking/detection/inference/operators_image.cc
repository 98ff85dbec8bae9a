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

constexpr int64_t kLongest = 64;  ///< side of a window, stride

std::array<int64_t, 2> Pair(const std::vector<int64_t>& values, const std::string& what, int64_t minimum) {
  if (values.size() != 2 || std::min(values[0], values[1]) < minimum || std::max(values[0], values[1]) > kLongest) {
    throw std::runtime_error(
        Concatenate(what, " of ", GraphShapeText(values), ", expected two numbers from ", minimum, " to ", kLongest));
  }
  return {values[0], values[1]};
}

/// Scale factor of each axis of an image.
std::vector<int64_t> FactorsOf(const OperatorArguments& arguments, const std::vector<int64_t>& shape) {
  const size_t scales = arguments.node().op == "Upsample" || arguments.opset() < 11 ? 1 : 2;
  std::vector<int64_t> factors;
  if (arguments.Has(3) && arguments.Input(3).size() > 0) {
    for (size_t i = 0; i < arguments.Ints(3).size() && i < shape.size(); ++i) {
      const int64_t wanted = arguments.Ints(3)[i];
      factors.push_back(shape[i] > 0 && wanted % shape[i] == 0 ? wanted / shape[i] : 0);
    }
  } else if (arguments.Has(scales)) {
    for (const float scale : arguments.Floats(scales)) {
      factors.push_back(scale >= 1 && scale <= float(kLongest) && scale == std::floor(scale) ? int64_t(scale) : 0);
    }
  } else {
    for (const float scale : arguments.node().attributes.contains("scales")
                                 ? arguments.node().attributes.at("scales").floats
                                 : std::vector<float>()) {
      factors.push_back(scale >= 1 && scale <= float(kLongest) && scale == std::floor(scale) ? int64_t(scale) : 0);
    }
  }
  const auto is_factor = [](int64_t factor) { return factor >= 1 && factor <= kLongest; };
  if (factors.size() == shape.size()) {
    const ImageAxes f(factors, arguments.channels_last());
    if (f.count == 1 && f.channels == 1 && is_factor(f.rows) && is_factor(f.columns)) return factors;
  }
  throw std::runtime_error(
      Concatenate("another size than a whole multiple of ", GraphShapeText(shape), "'s rows and columns"));
}

}  // namespace

ImageAxes::ImageAxes(const std::vector<int64_t>& shape, bool channels_last)
    : count(shape[0]),
      channels(shape[channels_last ? 3 : 1]),
      rows(shape[channels_last ? 1 : 2]),
      columns(shape[channels_last ? 2 : 3]) {}

std::vector<int64_t> ImageAxes::Shape(int64_t count, int64_t channels, int64_t rows, int64_t columns,
                                      bool channels_last) {
  if (channels_last) return {count, rows, columns, channels};
  return {count, channels, rows, columns};
}

ImageWindow::ImageWindow(const OperatorArguments& arguments, std::array<int64_t, 2> kernel_lengths,
                         std::array<int64_t, 2> image) {
  const GraphNode& node = arguments.node();
  kernel = Pair(node.Integers("kernel_shape", {kernel_lengths[0], kernel_lengths[1]}), "a window", 1);
  stride = Pair(node.Integers("strides", {1, 1}), "a stride", 1);
  dilation = Pair(node.Integers("dilations", {1, 1}), "a dilation", 1);
  const std::vector<int64_t> pads = node.Integers("pads", {0, 0, 0, 0});
  if (pads.size() != 4) throw std::runtime_error(Concatenate(pads.size(), " numbers of padding, expected 4"));
  const std::string automatic = node.Text("auto_pad", "NOTSET");
  for (size_t axis = 0; axis < 2; ++axis) {
    const int64_t extent = dilation[axis] * (kernel[axis] - 1) + 1;
    before[axis] = automatic == "NOTSET" ? pads[axis] : 0;
    after[axis] = automatic == "NOTSET" ? pads[axis + 2] : 0;
    if (automatic == "SAME_UPPER" || automatic == "SAME_LOWER") {
      const int64_t count = (image[axis] + stride[axis] - 1) / stride[axis];
      const int64_t total = std::max<int64_t>((count - 1) * stride[axis] + extent - image[axis], 0);
      before[axis] = automatic == "SAME_UPPER" ? total / 2 : (total + 1) / 2;
      after[axis] = total - before[axis];
    }
    if (std::min(before[axis], after[axis]) < 0 || std::max(before[axis], after[axis]) >= extent) {
      throw std::runtime_error(
          Concatenate("padding of ", before[axis], " and ", after[axis], ", expected 0 to ", extent - 1));
    }
    if (image[axis] + before[axis] + after[axis] < extent) {
      throw std::runtime_error(Concatenate("a window of ", extent, " on an image of ", image[axis]));
    }
  }
}

int64_t ImageWindow::Count(size_t axis, int64_t length, bool ceil) const {
  const int64_t extent = dilation[axis] * (kernel[axis] - 1) + 1;
  const int64_t room = length + before[axis] + after[axis] - extent;
  int64_t count = (ceil ? room + stride[axis] - 1 : room) / stride[axis] + 1;
  if (ceil && (count - 1) * stride[axis] >= length + before[axis]) --count;  // a window that begins in the padding
  return count;
}

const GraphTensor& ImageInput(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.FloatInput(0);
  if (input.rank() != 4 || input.size() == 0) {
    throw std::runtime_error("an input of " + GraphShapeText(input.shape) +
                             ", expected number x channels x rows x columns");
  }
  return input;
}

GraphTensor RunGlobalAveragePool(const OperatorArguments& arguments) {
  const GraphTensor& image = ImageInput(arguments);
  const bool last = arguments.channels_last();
  const ImageAxes axes(image.shape, last);
  const auto channels = size_t(axes.channels), pixels = size_t(axes.rows * axes.columns);
  std::vector<double> sums(size_t(axes.count) * channels, 0);
  const float* value = image.floats.data();
  if (last) {
    for (size_t n = 0; n < sums.size(); n += channels) {
      for (size_t i = 0; i < pixels; ++i) {
        for (size_t c = 0; c < channels; ++c) sums[n + c] += *value++;
      }
    }
  } else {
    for (double& sum : sums) {
      for (size_t i = 0; i < pixels; ++i) sum += *value++;
    }
  }
  std::vector<float> means(sums.size());
  std::transform(sums.begin(), sums.end(), means.begin(), [&](double sum) { return float(sum / double(pixels)); });
  return {ImageAxes::Shape(axes.count, axes.channels, 1, 1, last), std::move(means)};
}

std::vector<int64_t> ResizedShape(const OperatorArguments& arguments) {
  const std::vector<int64_t>& shape = ImageInput(arguments).shape;
  const std::string mode = arguments.node().Text("mode", "nearest");
  if (mode == "linear" && arguments.channels_last()) return arguments.List("sizes", 3);
  if (mode != "nearest") throw std::runtime_error("an interpolation other than nearest");
  std::vector<int64_t> resized = FactorsOf(arguments, shape);
  for (size_t i = 0; i < resized.size(); ++i) resized[i] *= shape[i];
  return resized;
}

GraphTensor RunPad(const OperatorArguments& arguments) {
  const GraphTensor& input = arguments.FloatInput(0);
  const std::vector<int64_t> pads = arguments.List("pads", 1);
  const size_t rank = input.shape.size();
  if (arguments.node().Text("mode", "constant") != "constant" || arguments.Number("value", 2, 0) != 0)
    throw std::runtime_error("padding with something else than zeros");
  if (rank == 0 || pads.size() != 2 * rank || *std::min_element(pads.begin(), pads.end()) < 0)
    throw std::runtime_error("padding of " + GraphShapeText(pads) + " for " + GraphShapeText(input.shape));
  std::vector<int64_t> shape = input.shape;
  for (size_t i = 0; i < rank; ++i) {
    GraphShapeSize({pads[i]});
    GraphShapeSize({pads[rank + i]});
    shape[i] += pads[i] + pads[rank + i];
  }
  const NewNumbers<float> result = arguments.New<float>(GraphShapeSize(shape));
  std::fill(result.begin(), result.end(), 0.0F);
  const auto row = size_t(input.shape.back());
  for (size_t from = 0; from < input.size(); from += row) {  // each row of the last axis to its place
    size_t rest = from / row, to = size_t(pads[rank - 1]), stride = size_t(shape[rank - 1]);
    for (size_t i = rank - 1; i-- > 0;) {
      const auto length = size_t(input.shape[i]);
      to += (rest % length + size_t(pads[i])) * stride;
      rest /= length;
      stride *= size_t(shape[i]);
    }
    std::copy_n(input.floats.begin() + from, row, result.begin() + to);
  }
  return {std::move(shape), result};
}

GraphTensor RunDepthToSpace(const OperatorArguments& arguments) {
  const GraphTensor& image = ImageInput(arguments);
  const int64_t block = arguments.node().Integer("blocksize", 0);
  if (!arguments.channels_last() || block < 1 || block > kLongest || image.shape[3] % (block * block) != 0)
    throw std::runtime_error(Concatenate("blocks of ", block, " of an image of ", GraphShapeText(image.shape)));
  const int64_t rows = image.shape[0] * image.shape[1], columns = image.shape[2];
  const int64_t together = image.shape[3] / block;  // numbers of a row of a block, one behind the other in both
  const NewNumbers<float> result = arguments.New<float>(image.size());
  float* to = result.data();
  for (int64_t y = 0; y < rows; ++y) {
    for (int64_t r = 0; r < block; ++r) {
      for (int64_t x = 0; x < columns; ++x) {
        to = std::copy_n(image.floats.data() + ((y * columns + x) * block + r) * together, together, to);
      }
    }
  }
  return {{image.shape[0], image.shape[1] * block, columns * block, together / block}, result};
}

GraphTensor RunBatchNormalization(const OperatorArguments& arguments) {
  const GraphTensor& image = ImageInput(arguments);
  const ImageAxes axes(image.shape, arguments.channels_last());
  const auto channels = size_t(axes.channels);
  const size_t together = arguments.channels_last() ? 1 : size_t(axes.rows * axes.columns);
  const float epsilon = arguments.node().Float("epsilon", 1e-5F);
  for (size_t i = 1; i < 5; ++i) {
    if (arguments.Floats(i).size() != channels)
      throw std::runtime_error(Concatenate("input ", i, ", expected ", channels, " numbers"));
  }
  std::vector<float> values = image.floats.Copy();
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t c = i / together % channels;
    const float scale = arguments.Floats(1)[c] / std::sqrt(arguments.Floats(4)[c] + epsilon);
    values[i] = scale * (values[i] - arguments.Floats(3)[c]) + arguments.Floats(2)[c];
  }
  return {image.shape, std::move(values)};
}

}  // namespace bodyloom
