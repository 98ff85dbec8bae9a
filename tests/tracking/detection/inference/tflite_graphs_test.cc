// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/graph_executor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "tests/tracking/detection/inference/small_networks.h"
#include "tests/tracking/detection/inference/tflite_reference.h"
#include "tests/tracking/detection/inference/tflite_writer.h"
#include "tracking/detection/inference/tflite_reader.h"
#include "tracking/detection/inference/tflite_shapes.h"

namespace bodyloom::tflite_graphs_test {
namespace {

using Writer = TfliteWriter;

OperatorGraph ModelOf(const Writer& writer) { return ParseTfliteGraph(writer.Bytes(), "small.tflite"); }

std::vector<float> InputOf(const OperatorGraph& model) {
  return SomeFloats(GraphShapeSize(model.tensors[static_cast<size_t>(model.inputs[0])].shape), 5);
}

/// Runs the network twice (the second time without first-time preparations) and compares all outputs; returns how many
/// numbers were compared. `largest` is that of the differences relative to the largest number of an output.
size_t ExpectAsReference(const Writer& writer, const std::string& what, double tolerance = 1e-6) {
  const OperatorGraph model = ModelOf(writer);
  const std::vector<float> input = InputOf(model);
  const std::vector<std::vector<float>> expected = RunReference(model, input);
  const GraphExecutor network(model);
  size_t compared = 0;
  for (int run = 0; run < 2; ++run) {
    const std::vector<GraphTensor> outputs = network.Run(input);
    EXPECT_EQ(outputs.size(), model.outputs.size()) << what;
    for (size_t i = 0; i < outputs.size(); ++i) {
      const auto tensor = static_cast<size_t>(model.outputs[i]);
      EXPECT_EQ(outputs[i].shape, model.tensors[tensor].shape) << what;
      const std::vector<float>& reference = expected[tensor];
      EXPECT_EQ(outputs[i].floats.size(), reference.size()) << what;
      double largest = 1, difference = 0;
      for (size_t j = 0; j < std::min(reference.size(), outputs[i].floats.size()); ++j, ++compared) {
        largest = std::max(largest, std::abs(static_cast<double>(reference[j])));
        difference = std::max(difference, std::abs(static_cast<double>(reference[j]) - outputs[i].floats[j]));
      }
      EXPECT_LE(difference, tolerance * largest) << what << ", output " << i;
    }
  }
  return compared;
}

int Strided(int size, int kernel, int stride, bool same) {
  return same ? (size - 1) / stride + 1 : (size - kernel) / stride + 1;
}

TEST(TfliteGraphs, Convolutions) {
  size_t compared = 0;
  for (const auto storage : {Writer::Storage::kFloat32, Writer::Storage::kFloat16, Writer::Storage::kSparse}) {
    for (const bool same : {false, true}) {
      for (const int stride : {1, 2}) {
        for (const auto& [height, width] : {std::pair{1, 1}, {2, 2}, {3, 3}, {5, 5}, {3, 1}, {2, 5}}) {
          for (const auto& [rows, columns] : {std::pair{8, 8}, {7, 10}, {9, 7}}) {
            Writer writer;
            const int input = writer.Input({1, rows, columns, 5});
            const std::vector<int> shape = {1, Strided(rows, height, stride, same),
                                            Strided(columns, width, stride, same), 9};
            const bool relu6 = (height + rows) % 2 == 0;
            writer.outputs = {writer.Conv(input, {9, height, width, 5}, shape, same, stride, relu6, storage,
                                          storage != Writer::Storage::kFloat32)};
            compared += ExpectAsReference(writer, Concatenate("kernel ", height, "x", width, " stride ", stride, " on ",
                                                              rows, "x", columns, same ? " SAME" : " VALID"));
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 50'000U);
}

TEST(TfliteGraphs, DepthwiseConvolutions) {
  size_t compared = 0;
  for (const bool same : {false, true}) {
    for (const int stride : {1, 2}) {
      for (const int side : {3, 5}) {
        for (const int channels : {1, 3, 16}) {
          for (const auto& [rows, columns] : {std::pair{8, 8}, {7, 10}}) {
            Writer writer;
            const int input = writer.Input({1, rows, columns, channels});
            const std::vector<int> shape = {1, Strided(rows, side, stride, same), Strided(columns, side, stride, same),
                                            channels};
            writer.outputs = {writer.Depthwise(input, side, side, shape, same, stride, side == 5)};
            compared += ExpectAsReference(writer, Concatenate("side ", side, " stride ", stride, " on ", rows, "x",
                                                              columns, "x", channels, same ? " SAME" : " VALID"));
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 10'000U);
}

TEST(TfliteGraphs, Sums) {
  Writer writer;
  const int input = writer.Input({1, 4, 6, 3}), conv = writer.Conv(input, {3, 1, 1, 3}, {1, 4, 6, 3}, true, 1);
  const int clamped = writer.Apply(Writer::kAdd, {input, conv}, {1, 4, 6, 3}, {{0, 3}});
  writer.outputs = {clamped, writer.Apply(Writer::kAdd, {clamped, input}, {1, 4, 6, 3}),
                    writer.Apply(Writer::kAdd, {input, input}, {1, 4, 6, 3})};
  ExpectAsReference(writer, "sums");
}

TEST(TfliteGraphs, PaddingOfRowsAndColumns) {
  // Even: folded into both convolutions that take it. Uneven, before SAME, before something else, and asked for itself.
  const std::vector<std::vector<int32_t>> paddings = {{0, 0, 1, 1, 2, 2, 0, 0}, {0, 0, 0, 1, 0, 1, 0, 0}};
  for (const std::vector<int32_t>& n : paddings) {
    const int rows = 6 + n[2] + n[3], columns = 7 + n[4] + n[5];
    Writer writer;
    const int input = writer.Input({1, 6, 7, 2});
    const int pad = writer.Pad(input, n, {1, rows, columns, 2});
    writer.outputs = {
        writer.Conv(pad, {4, 3, 3, 2}, {1, rows - 2, columns - 2, 4}, false, 1),
        writer.Conv(pad, {4, 3, 3, 2}, {1, Strided(rows, 3, 2, true), Strided(columns, 3, 2, true), 4}, true, 2),
        writer.Depthwise(pad, 3, 3, {1, (rows - 3) / 2 + 1, (columns - 3) / 2 + 1, 2}, false, 2),
        writer.Apply(Writer::kLogistic, {pad}, {1, rows, columns, 2}), pad};
    ExpectAsReference(writer, "padding");
    writer.outputs.pop_back();
    ExpectAsReference(writer, "padding within");
    writer.outputs.resize(2);
    ExpectAsReference(writer, "padding before convolutions alone");
  }
}

TEST(TfliteGraphs, PaddingOfChannels) {
  Writer writer;
  const int input = writer.Input({1, 4, 5, 3});
  const int pad = writer.Pad(input, {0, 0, 0, 0, 0, 0, 2, 1}, {1, 4, 5, 6});
  const int all = writer.Pad(pad, {0, 0, 1, 1, 1, 1, 0, 4}, {1, 6, 7, 10});
  writer.outputs = {pad, writer.Conv(pad, {2, 3, 3, 6}, {1, 4, 5, 2}, true, 1), all,
                    writer.Conv(all, {2, 3, 3, 10}, {1, 4, 5, 2}, false, 1)};
  ExpectAsReference(writer, "channels");
}

TEST(TfliteGraphs, Resizes) {
  for (const auto& [height, width] : {std::pair{8, 10}, {12, 15}, {4, 10}, {7, 9}, {2, 3}, {2, 5}}) {
    Writer writer;
    const int input = writer.Input({1, 4, 5, 3}), size = writer.Ints({2}, {height, width});
    writer.outputs = {writer.Apply(Writer::kResizeBilinear, {input, size}, {1, height, width, 3}, {{2, 0}, {3, 1}})};
    ExpectAsReference(writer, Concatenate(height, "x", width), 2e-6);
  }
}

TEST(TfliteGraphs, Pooling) {
  for (const int side : {2, 3}) {
    for (const int stride : {1, 2}) {
      Writer writer;
      const int input = writer.Input({1, 7, 8, 3});
      writer.outputs = {writer.Apply(Writer::kMaxPool2d, {input},
                                     {1, Strided(7, side, stride, false), Strided(8, side, stride, false), 3},
                                     {{0, 1}, {1, stride}, {2, stride}, {3, side}, {4, side}, {5, 0}})};
      ExpectAsReference(writer, Concatenate(side, " ", stride), 0);
    }
  }
}

TEST(TfliteGraphs, ReshapesFollowTheOrderOfTflite) {
  Writer writer;
  const int input = writer.Input({1, 4, 6, 5});
  const auto reshape = [&](int from, const std::vector<int32_t>& to, const std::vector<int>& shape) {
    return writer.Apply(Writer::kReshape, {from, writer.Ints({static_cast<int>(to.size())}, to)}, shape);
  };
  const int flat = reshape(input, {1, -1, 5}, {1, 24, 5}), row = reshape(flat, {-1}, {120});
  writer.outputs = {flat,
                    row,
                    reshape(row, {1, 3, 4, 10}, {1, 3, 4, 10}),
                    reshape(input, {1, 3, -1, 10}, {1, 3, 4, 10}),
                    reshape(flat, {1, 24, 5, 1}, {1, 24, 5, 1}),
                    reshape(input, {1, 1, 1, 120}, {1, 1, 1, 120})};
  ExpectAsReference(writer, "reshapes", 0);
}

TEST(TfliteGraphs, DepthToSpace) {
  for (const int block : {2, 3}) {
    Writer writer;
    const int input = writer.Input({1, 3, 4, 36});
    writer.outputs = {
        writer.Apply(Writer::kDepthToSpace, {input}, {1, 3 * block, 4 * block, 36 / (block * block)}, {{0, block}})};
    ExpectAsReference(writer, "depth to space", 0);
  }
}

TEST(TfliteGraphs, ConcatenationAlongEveryAxis) {
  for (const int axis : {1, 2, 3, -1}) {
    Writer writer;
    const int input = writer.Input({1, 3, 4, 2});
    const int logistic = writer.Apply(Writer::kLogistic, {input}, {1, 3, 4, 2});
    std::vector<int> shape = {1, 3, 4, 2};
    shape[static_cast<size_t>((axis + 4) % 4)] *= 3;
    writer.outputs = {writer.Apply(Writer::kConcatenation, {input, logistic, input}, shape, {{0, axis}, {1, 3}}),
                      logistic};
    ExpectAsReference(writer, Concatenate("axis ", axis));
  }
  Writer writer;
  const int input = writer.Input({1, 3, 4, 2});
  const int flat = writer.Apply(Writer::kReshape, {input, writer.Ints({3}, {1, 12, 2})}, {1, 12, 2});
  const int other = writer.Apply(Writer::kLogistic, {flat}, {1, 12, 2});
  writer.outputs = {writer.Apply(Writer::kConcatenation, {flat, other}, {1, 24, 2}, {{0, 1}})};
  ExpectAsReference(writer, "rows");
}

TEST(TfliteGraphs, SlopesOfNegativeNumbers) {
  for (const auto storage : {Writer::Storage::kFloat32, Writer::Storage::kFloat16}) {
    Writer writer;
    const int input = writer.Input({1, 5, 6, 7}), slopes = writer.Floats({1, 1, 7}, SomeFloats(7, 3), storage);
    const int conv = writer.Conv(input, {7, 3, 3, 7}, {1, 5, 6, 7}, true, 1);
    const int sum = writer.Apply(Writer::kAdd, {conv, input}, {1, 5, 6, 7}, {{0, 0}});
    const int leaky = writer.Apply(Writer::kPrelu, {sum, slopes}, {1, 5, 6, 7});
    writer.outputs = {writer.Apply(Writer::kPrelu, {input, slopes}, {1, 5, 6, 7}), leaky,
                      writer.Apply(Writer::kAdd, {leaky, sum}, {1, 5, 6, 7}, {{0, 0}})};
    ExpectAsReference(writer, "slopes");
  }
}

TEST(TfliteGraphs, MeansAndFullConnections) {
  const std::vector<std::pair<std::vector<int32_t>, std::vector<int>>> cases = {
      {{1, 2}, {1, 6}}, {{2, 1}, {1, 6}}, {{1, 2, 3}, {1}}, {{2}, {1, 4, 6}}, {{0, 1, 2}, {6}}};
  for (const auto& [axes, shape] : cases) {
    Writer writer;
    const int input = writer.Input({1, 4, 5, 6}), list = writer.Ints({static_cast<int>(axes.size())}, axes);
    writer.outputs = {writer.Apply(Writer::kMean, {input, list}, shape, {{0, 0}})};
    ExpectAsReference(writer, Concatenate("mean over ", axes.size(), " axes"), 1e-6);
  }
  Writer writer;
  const int input = writer.Input({1, 4, 5, 6}), axes = writer.Ints({2}, {1, 2});
  const int mean = writer.Apply(Writer::kMean, {input, axes}, {1, 6}, {{0, 0}});
  const int weights = writer.Floats({9, 6}, SomeFloats(54, 5), Writer::Storage::kFloat16);
  const int bias = writer.Floats({9}, SomeFloats(9, 6), Writer::Storage::kFloat16);
  const int clamped = writer.Apply(Writer::kFullyConnected, {mean, weights, bias}, {1, 9}, {{0, 3}});
  const int rows = writer.Apply(Writer::kReshape, {input, writer.Ints({2}, {20, 6})}, {20, 6});
  writer.outputs = {clamped, writer.Apply(Writer::kFullyConnected, {mean, weights, bias}, {1, 9}, {{0, 0}}),
                    writer.Apply(Writer::kFullyConnected, {rows, weights, -1}, {20, 9}, {{0, 0}}),
                    writer.Apply(Writer::kMean, {input, axes}, {1, 1, 1, 6}, {{0, 1}})};
  ExpectAsReference(writer, "full connections", 1e-6);
}

TEST(TfliteGraphs, Slices) {
  Writer writer;
  const int input = writer.Input({1, 4, 5, 6});
  const auto slice = [&](const std::vector<int32_t>& begin, const std::vector<int32_t>& end,
                         const std::vector<int>& shape) {
    return writer.Apply(Writer::kStridedSlice,
                        {input, writer.Ints({4}, begin), writer.Ints({4}, end), writer.Ints({4}, {1, 1, 1, 1})}, shape,
                        {{0, 0}});
  };
  writer.outputs = {slice({0, 0, 0, 0}, {1, 4, 5, 3}, {1, 4, 5, 3}), slice({0, 1, 2, 5}, {1, 3, 5, 6}, {1, 2, 3, 1}),
                    slice({0, 0, 0, 0}, {1, 4, 5, 6}, {1, 4, 5, 6})};
  ExpectAsReference(writer, "slices", 0);
}

TEST(TfliteGraphs, WholeNetworks) {
  for (const Writer& writer : SmallNetworks()) ExpectAsReference(writer, "whole");
}

/// Graphs of 30 random operators on one size of image, where tensors are read once, twice or never, soon or late, and
/// wanted or not: which buffers are shared, and which sums are done in place, differs in each.
TEST(TfliteGraphs, RandomGraphs) {
  size_t compared = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    HashRandom random(seed, {1});
    const auto below = [&random](size_t n) { return static_cast<size_t>(random.Uniform() * static_cast<double>(n)); };
    const std::vector<int> shape = {1, 5, 6, 4}, padded = {1, 7, 8, 4};
    Writer writer;
    std::vector<int> images = {writer.Input(shape)};
    // Mostly the latest: chains with now and then a long link.
    const auto any = [&] { return random.Uniform() < 0.6 ? images.back() : images[below(images.size())]; };
    for (int i = 0; i < 30; ++i) {
      const bool relu6 = random.Uniform() < 0.3;
      switch (below(6)) {
        case 0:
          images.push_back(writer.Conv(any(), {4, 1, 1, 4}, shape, true, 1, relu6));
          break;
        case 1:
          images.push_back(writer.Depthwise(any(), 3, 3, shape, true, 1, relu6));
          break;
        case 2: {
          const int pad = writer.Pad(any(), {0, 0, 1, 1, 0, 2, 0, 0}, padded);
          images.push_back(writer.Depthwise(pad, 3, 3, shape, false, 1, relu6));
          if (relu6) images.push_back(writer.Conv(pad, {4, 3, 3, 4}, shape, false, 1));
          break;
        }
        case 3: {
          const int flat = writer.Apply(Writer::kReshape, {any(), writer.Ints({2}, {1, 120})}, {1, 120});
          images.push_back(writer.Apply(Writer::kReshape, {flat, writer.Ints({4}, shape)}, shape));
          break;
        }
        default:
          images.push_back(writer.Apply(Writer::kAdd, {any(), any()}, shape, {{0, relu6 ? 3 : 0}}));
      }
    }
    const auto computed = [&] { return images[1 + below(images.size() - 1)]; };
    writer.outputs = {images.back(), computed(), computed()};
    compared += ExpectAsReference(writer, Concatenate("seed ", seed), 1e-5);
  }
  EXPECT_GT(compared, 40'000U);
}

TEST(TfliteGraphs, WhatNoWantedOutputNeedsIsLeftOut) {
  const OperatorGraph model = ModelOf(SmallNetworks()[0]);
  ASSERT_EQ(model.outputs.size(), 3U);
  const std::vector<float> input = InputOf(model);
  GraphExecutor all(model), two(model, {}, {2, 0}), twice(model, {}, {1, 1});
  EXPECT_EQ(all.num_steps(), 10U) << "11 operators, of which a convolution does the sum";
  EXPECT_LT(two.num_steps(), all.num_steps());
  const std::vector<GraphTensor> expected = all.Run(input), outputs = two.Run(input), same = twice.Run(input);
  ASSERT_EQ(outputs.size(), 2U);
  EXPECT_EQ(outputs[0].floats, expected[2].floats);
  EXPECT_EQ(outputs[1].floats, expected[0].floats);
  ASSERT_EQ(same.size(), 2U);
  EXPECT_EQ(same[0].floats, expected[1].floats);
  EXPECT_EQ(same[1].floats, expected[1].floats);
}

TEST(TfliteGraphs, ARunMayLeaveTheLastOutputsOut) {
  for (const TfliteWriter& writer : SmallNetworks()) {
    const OperatorGraph model = ModelOf(writer);
    const std::vector<float> input = InputOf(model), other(input.size(), 0.25F);
    const GraphExecutor network(model);
    const std::vector<GraphTensor> expected = network.Run(input);
    for (int count = 0; count <= int(expected.size()); ++count) {
      const std::vector<GraphTensor> outputs = network.Run(input, count);
      ASSERT_EQ(outputs.size(), size_t(count));
      for (int i = 0; i < count; ++i) EXPECT_EQ(outputs[size_t(i)].floats, expected[size_t(i)].floats);
      (void)network.Run(other, count);  // the same memory
      const std::vector<GraphTensor> again = network.Run(input);
      for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(again[i].floats, expected[i].floats);
    }
    EXPECT_THROW((void)network.Run(input, int(expected.size()) + 1), std::invalid_argument);
    EXPECT_THROW((void)network.Run(input, -1), std::invalid_argument);
  }
}

TEST(TfliteGraphs, OutlivesItsModel) {
  auto model = std::make_unique<OperatorGraph>(ModelOf(SmallNetworks()[0]));
  const std::vector<float> input = InputOf(*model);
  GraphExecutor first(*model), second(*model);
  const std::vector<GraphTensor> expected = first.Run(input);
  model.reset();
  GraphExecutor moved = std::move(second);
  const std::vector<GraphTensor> outputs = moved.Run(input);
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(outputs[i].floats, expected[i].floats);
}

TEST(TfliteGraphs, CopiesShareNothingThatARunChanges) {
  const OperatorGraph model = ModelOf(SmallNetworks()[0]);
  const std::vector<float> input = InputOf(model), other(input.size(), 0.5F);
  auto first = std::make_unique<GraphExecutor>(model);
  const std::vector<GraphTensor> expected = first->Run(input);
  GraphExecutor copy(*first);
  (void)copy.Run(other);
  first.reset();
  const std::vector<GraphTensor> outputs = copy.Run(input);
  ASSERT_EQ(outputs.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(outputs[i].floats, expected[i].floats);
}

TEST(TfliteGraphs, TwoThreadsGiveTheBitsOfOne) {
  const OperatorGraph model = ModelOf(SmallNetworks()[0]);
  GraphExecutor alone(model);
  constexpr int kRuns = 40;
  std::vector<std::vector<GraphTensor>> expected(kRuns);
  const auto input = [&](int run) { return SomeFloats(InputOf(model).size(), static_cast<uint32_t>(run)); };
  for (int run = 0; run < kRuns; ++run) expected[static_cast<size_t>(run)] = alone.Run(input(run));
  std::vector<std::thread> threads;
  threads.reserve(2);
  std::vector<int> different(2, 0);
  for (size_t t = 0; t < 2; ++t) {
    threads.emplace_back([&, t] {
      GraphExecutor own = t == 0 ? GraphExecutor(alone) : GraphExecutor(model);
      for (int run = 0; run < kRuns; ++run) {
        const std::vector<GraphTensor> outputs = own.Run(input(run));
        for (size_t i = 0; i < outputs.size(); ++i) {
          different[t] += outputs[i].floats != expected[static_cast<size_t>(run)][i].floats ? 1 : 0;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(different, std::vector<int>(2, 0));
}

TEST(TfliteGraphs, WrongArguments) {
  const OperatorGraph model = ModelOf(SmallNetworks()[0]);
  EXPECT_THROW(GraphExecutor(model, {}, {3}), std::invalid_argument);
  EXPECT_THROW(GraphExecutor(model, {}, {-1}), std::invalid_argument);
  const GraphExecutor network(model);
  EXPECT_THROW((void)network.Run(std::vector<float>(7)), std::invalid_argument);
  EXPECT_THROW(GraphExecutor(model, {1, 8, 9, 3}), std::invalid_argument);
  OperatorGraph two = model;
  two.inputs.push_back(two.inputs[0]);
  EXPECT_THROW(GraphExecutor{two}, std::invalid_argument);
}

TEST(TfliteShapes, SamePaddingIsTensorFlows) {
  struct Case {
    int size, kernel, stride, before, after;
  };
  for (const Case& c : {Case{256, 3, 2, 0, 1},
                        {255, 3, 2, 1, 1},
                        {64, 3, 1, 1, 1},
                        {64, 5, 1, 2, 2},
                        {64, 5, 2, 1, 2},
                        {64, 1, 2, 0, 0},
                        {7, 2, 1, 0, 1},
                        {8, 2, 2, 0, 0},
                        {7, 2, 2, 0, 1},
                        {1, 3, 2, 1, 1}}) {
    const TflitePads pads = SamePads(c.size, c.kernel, c.stride);
    EXPECT_EQ(pads.before, c.before) << c.size << " " << c.kernel << " " << c.stride;
    EXPECT_EQ(pads.after, c.after) << c.size << " " << c.kernel << " " << c.stride;
  }
}

}  // namespace
}  // namespace bodyloom::tflite_graphs_test
