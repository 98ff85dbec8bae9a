// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/onnx_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int64_t kLongest = 64;  ///< side of a window, stride

std::array<int64_t, 2> Pair(const std::vector<int64_t>& values, const std::string& what, int64_t least) {
  if (values.size() != 2 || std::min(values[0], values[1]) < least || std::max(values[0], values[1]) > kLongest) {
    throw std::runtime_error(
        Concatenate(what, " of ", OnnxShapeText(values), ", expected two numbers from ", least, " to ", kLongest));
  }
  return {values[0], values[1]};
}

/// How often each axis of an image is repeated.
std::vector<int64_t> FactorsOf(const OnnxArguments& arguments, const std::vector<int64_t>& shape) {
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
  const bool fit = factors.size() == shape.size() && factors[0] == 1 && factors[1] == 1;
  if (!fit || std::min(factors[2], factors[3]) < 1 || std::max(factors[2], factors[3]) > kLongest) {
    throw std::runtime_error(
        Concatenate("another size than a whole multiple of ", OnnxShapeText(shape), "'s rows and columns"));
  }
  return factors;
}

}  // namespace

OnnxWindow::OnnxWindow(const OnnxArguments& arguments, std::array<int64_t, 2> kernel_lengths,
                       std::array<int64_t, 2> image) {
  const OnnxNode& node = arguments.node();
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

int64_t OnnxWindow::Count(size_t axis, int64_t length, bool ceil) const {
  const int64_t extent = dilation[axis] * (kernel[axis] - 1) + 1;
  const int64_t room = length + before[axis] + after[axis] - extent;
  int64_t count = (ceil ? room + stride[axis] - 1 : room) / stride[axis] + 1;
  if (ceil && (count - 1) * stride[axis] >= length + before[axis]) --count;  // a window that begins in the padding
  return count;
}

const OnnxTensor& OnnxImage(const OnnxArguments& arguments) {
  const OnnxTensor& input = arguments.FloatInput(0);
  if (input.rank() != 4 || input.size() == 0) {
    throw std::runtime_error("an input of " + OnnxShapeText(input.shape) +
                             ", expected number x channels x rows x columns");
  }
  return input;
}

OnnxTensor OnnxMaxPool(const OnnxArguments& arguments) {
  const OnnxTensor& image = OnnxImage(arguments);
  const int64_t height = image.shape[2], width = image.shape[3];
  const OnnxWindow window(arguments, {0, 0}, {height, width});
  const bool ceil = arguments.node().Integer("ceil_mode", 0) != 0;
  const int64_t rows = window.Count(0, height, ceil), columns = window.Count(1, width, ceil);
  const size_t channels = size_t(image.shape[0] * image.shape[1]);
  std::vector<int64_t> shape = {image.shape[0], image.shape[1], rows, columns};
  std::vector<float> result(OnnxShapeSize(shape));
  std::vector<float> along(size_t(height * columns));  // maxima of each row of the image
  for (size_t c = 0; c < channels; ++c) {
    const float* from = image.floats->data() + c * size_t(height * width);
    float* to = result.data() + c * size_t(rows * columns);
    const auto largest = [&window](const float* at, int64_t step, int64_t place, size_t axis, int64_t length) {
      float best = -std::numeric_limits<float>::infinity();
      for (int64_t k = 0; k < window.kernel[axis]; ++k) {
        const int64_t i = place * window.stride[axis] - window.before[axis] + k * window.dilation[axis];
        if (i >= 0 && i < length) best = std::max(best, at[i * step]);
      }
      return best;
    };
    for (int64_t y = 0; y < height; ++y) {
      for (int64_t x = 0; x < columns; ++x) along[size_t(y * columns + x)] = largest(from + y * width, 1, x, 1, width);
    }
    for (int64_t y = 0; y < rows; ++y) {
      for (int64_t x = 0; x < columns; ++x) to[y * columns + x] = largest(along.data() + x, columns, y, 0, height);
    }
  }
  return {std::move(shape), std::move(result)};
}

OnnxTensor OnnxGlobalAveragePool(const OnnxArguments& arguments) {
  const OnnxTensor& image = OnnxImage(arguments);
  const size_t channels = size_t(image.shape[0] * image.shape[1]), pixels = size_t(image.shape[2] * image.shape[3]);
  std::vector<float> result(channels);
  for (size_t c = 0; c < channels; ++c) {
    double sum = 0;
    for (size_t i = 0; i < pixels; ++i) sum += (*image.floats)[c * pixels + i];
    result[c] = float(sum / double(pixels));
  }
  return {{image.shape[0], image.shape[1], 1, 1}, std::move(result)};
}

OnnxTensor OnnxEnlarge(const OnnxArguments& arguments) {
  const OnnxTensor& image = OnnxImage(arguments);
  if (arguments.node().Text("mode", "nearest") != "nearest")
    throw std::runtime_error("an interpolation other than nearest");
  const std::vector<int64_t> factors = FactorsOf(arguments, image.shape);
  const int64_t width = image.shape[3];
  std::vector<int64_t> shape = {image.shape[0], image.shape[1], image.shape[2] * factors[2], width * factors[3]};
  std::vector<float> result(OnnxShapeSize(shape));
  float* to = result.data();
  const int64_t lines = image.shape[0] * image.shape[1] * image.shape[2];
  for (int64_t line = 0; line < lines; ++line) {
    const float* from = image.floats->data() + line * width;
    const float* row = to;
    for (int64_t x = 0; x < width; ++x) to = std::fill_n(to, factors[3], from[x]);
    for (int64_t copy = 1; copy < factors[2]; ++copy) to = std::copy_n(row, shape[3], to);
  }
  return {std::move(shape), std::move(result)};
}

OnnxTensor OnnxBatchNormalization(const OnnxArguments& arguments) {
  const OnnxTensor& image = OnnxImage(arguments);
  const auto channels = size_t(image.shape[1]), pixels = size_t(image.shape[2] * image.shape[3]);
  const float epsilon = arguments.node().Float("epsilon", 1e-5F);
  for (size_t i = 1; i < 5; ++i) {
    if (arguments.Floats(i).size() != channels)
      throw std::runtime_error(Concatenate("input ", i, ", expected ", channels, " numbers"));
  }
  std::vector<float> values = *image.floats;
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t c = i / pixels % channels;
    const float scale = arguments.Floats(1)[c] / std::sqrt(arguments.Floats(4)[c] + epsilon);
    values[i] = scale * (values[i] - arguments.Floats(3)[c]) + arguments.Floats(2)[c];
  }
  return {image.shape, std::move(values)};
}

}  // namespace bodyloom
