// SPDX-License-Identifier: Apache-2.0
/// Small networks that together use every operator and every storage of constants.
#pragma once

#include <string>
#include <vector>

#include "tests/tracking/detection/inference/tflite_writer.h"
#include "tracking/detection/inference/tflite_reader.h"

namespace bodyloom {

/// The first has three outputs (a row of numbers, their logistic, an image independent of the others) and one input,
/// 1×8×8×3, like BlazePose's landmark networks; the second is built like its detector, the third like the networks of
/// hands and faces.
inline std::vector<TfliteWriter> SmallNetworks() {
  using Writer = TfliteWriter;
  Writer landmarks;
  {
    Writer& w = landmarks;
    const int input = w.Input({1, 8, 8, 3});
    const int down = w.Conv(input, {4, 3, 3, 3}, {1, 4, 4, 4}, true, 2, true);
    const int block = w.Conv(w.Depthwise(down, 3, 3, {1, 4, 4, 4}, true, 1, true), {4, 1, 1, 4}, {1, 4, 4, 4}, true, 1);
    const int sum = w.Apply(Writer::kAdd, {down, block}, {1, 4, 4, 4}, {{0, 3}});
    const int pooled =
        w.Apply(Writer::kMaxPool2d, {sum}, {1, 2, 2, 4}, {{0, 1}, {1, 2}, {2, 2}, {3, 2}, {4, 2}, {5, 0}});
    const int wide = w.Pad(pooled, {0, 0, 0, 0, 0, 0, 0, 2}, {1, 2, 2, 6});
    const int row = w.Conv(wide, {5, 2, 2, 6}, {1, 1, 1, 5}, false, 1, false, Writer::Storage::kFloat32);
    const int flat = w.Apply(Writer::kReshape, {row, w.Ints({2}, {-1, 5})}, {1, 5});
    const int size = w.Ints({2}, {8, 8});
    const int large = w.Apply(Writer::kResizeBilinear, {sum, size}, {1, 8, 8, 4}, {{2, 0}, {3, 1}});
    const int mask = w.Conv(large, {1, 1, 1, 4}, {1, 8, 8, 1}, true, 1, false, Writer::Storage::kFloat16, false);
    w.outputs = {flat, w.Apply(Writer::kLogistic, {flat}, {1, 5}), mask};
  }
  Writer detector;
  {
    Writer& w = detector;
    const int input = w.Input({1, 8, 8, 3});
    const int pad = w.Pad(input, {0, 0, 0, 1, 0, 1, 0, 0}, {1, 9, 9, 3});
    const int down = w.Conv(pad, {8, 3, 3, 3}, {1, 4, 4, 8}, false, 2, true);
    const int sparse = w.Conv(down, {16, 1, 1, 8}, {1, 4, 4, 16}, true, 1, true, Writer::Storage::kSparse);
    const int even = w.Pad(sparse, {0, 0, 2, 2, 2, 2, 0, 0}, {1, 8, 8, 16});
    const int smooth = w.Depthwise(even, 5, 5, {1, 4, 4, 16}, false, 1);
    const int spread = w.Apply(Writer::kDepthToSpace, {smooth}, {1, 8, 8, 4}, {{0, 2}});
    const int fine = w.Apply(Writer::kReshape, {spread, w.Ints({3}, {1, 128, 2})}, {1, 128, 2});
    const int coarse = w.Apply(Writer::kReshape, {sparse, w.Ints({3}, {1, -1, 2})}, {1, 128, 2});
    w.outputs = {w.Apply(Writer::kConcatenation, {fine, coarse}, {1, 256, 2}, {{0, 1}, {1, 0}})};
  }
  Writer hand;
  {
    Writer& w = hand;
    const int input = w.Input({1, 8, 8, 3});
    const int down = w.Conv(input, {4, 3, 3, 3}, {1, 3, 3, 4}, true, 3);
    const int slopes = w.Floats({1, 1, 4}, SomeFloats(4, 3), Writer::Storage::kFloat16);
    const int leaky = w.Apply(Writer::kPrelu, {down, slopes}, {1, 3, 3, 4});
    const int begin = w.Ints({4}, {0, 0, 0, 1}), end = w.Ints({4}, {1, 3, 3, 4}), step = w.Ints({4}, {1, 1, 1, 1});
    const int part = w.Apply(Writer::kStridedSlice, {leaky, begin, end, step}, {1, 3, 3, 3}, {{0, 0}});
    const int mean = w.Apply(Writer::kMean, {part, w.Ints({2}, {1, 2})}, {1, 3}, {{0, 0}});
    const int weights = w.Floats({2, 3}, SomeFloats(6, 8), Writer::Storage::kFloat16), bias = w.Floats({2}, {1, -2});
    w.outputs = {w.Apply(Writer::kFullyConnected, {mean, weights, bias}, {1, 2}, {{0, 0}})};
  }
  return {landmarks, detector, hand};
}

/// A constant's values, to compare.
inline std::vector<float> ValuesOf(const OperatorGraph::Tensor& tensor) { return tensor.constant.floats.Copy(); }

/// A convolution of a 1×4×4×2 input; its tensors are 0 input, 1 kernel, 2 bias, 3 output.
inline TfliteWriter OneConvolution() {
  using Writer = TfliteWriter;
  Writer writer;
  const int input = writer.Input({1, 4, 4, 2}), kernel = writer.Floats({3, 1, 1, 2}, {1, 2, 3, 4, 5, 6});
  const int bias = writer.Floats({3}, {7, 8, 9});
  writer.outputs = {
      writer.Apply(Writer::kConv2d, {input, kernel, bias}, {1, 4, 4, 3}, {{0, 0}, {1, 1}, {2, 1}, {3, 3}})};
  return writer;
}

}  // namespace bodyloom
