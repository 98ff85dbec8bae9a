// SPDX-License-Identifier: Apache-2.0
/// ONNX networks with the interface of detectors, and outputs known in closed form.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/tracking/detection/inference/onnx_writer.h"

namespace bodyloom {

/// A network whose outputs depend on the image's mean red:
///   fixed + red · moved,   red = the mean of the input's first plane.
/// `fixed` and `moved` hold an output's numbers in C order.
struct ScriptedOutput {
  std::vector<int64_t> shape;
  std::vector<float> fixed, moved;
};

inline OnnxWriter ScriptedNetwork(const std::vector<int64_t>& input, const std::vector<ScriptedOutput>& outputs) {
  OnnxWriter writer;
  writer.Input("images", input).Ints("zero", {1}, {0}).Ints("one", {1}, {1});
  writer.Node("GlobalAveragePool", {"images"}, {"means"});
  writer.Node("Slice", {"means", "zero", "one", "one"}, {"red"});
  writer.Ints("shape", {3}, {1, 1, 1}).Node("Reshape", {"red", "shape"}, {"mean red"});
  for (size_t i = 0; i < outputs.size(); ++i) {
    const std::string name = "output" + std::to_string(i);
    writer.Floats(name + " fixed", outputs[i].shape, outputs[i].fixed);
    writer.Floats(name + " moved", outputs[i].shape, outputs[i].moved);
    writer.Node("Mul", {"mean red", name + " moved"}, {name + " change"});
    writer.Node("Add", {name + " fixed", name + " change"}, {name});
    writer.Output(name);
  }
  return writer;
}

/// One anchor of a YOLO-pose network, in pixels of the letterbox.
struct ScriptedPerson {
  float x = 0, y = 0, width = 0, height = 0, score = 0;
  std::vector<float> points;  ///< x, y, visibility of each landmark
  float right = 0;            ///< shift of box and landmarks to the right at full red
};

/// 1×(5 + 3K)×anchors; anchors beyond the people are empty.
inline OnnxWriter ScriptedYoloPose(const std::vector<int64_t>& input, const std::vector<ScriptedPerson>& people,
                                   size_t landmarks, size_t anchors) {
  const size_t rows = 5 + 3 * landmarks;
  ScriptedOutput output = {{1, static_cast<int64_t>(rows), static_cast<int64_t>(anchors)},
                           std::vector<float>(rows * anchors, 0.0F),
                           std::vector<float>(rows * anchors, 0.0F)};
  for (size_t i = 0; i < people.size(); ++i) {
    const ScriptedPerson& person = people[i];
    const float box[] = {person.x, person.y, person.width, person.height, person.score};
    for (size_t row = 0; row < rows; ++row) {
      output.fixed[row * anchors + i] = row < 5 ? box[row] : person.points.at(row - 5);
      if (row == 0 || (row >= 5 && (row - 5) % 3 == 0)) output.moved[row * anchors + i] = person.right;
    }
  }
  return ScriptedNetwork(input, {output});
}

/// A standing COCO person: 17 landmarks within a box of this centre and height, all with this visibility.
inline ScriptedPerson ScriptedStanding(float x, float y, float height, float score, float visibility) {
  constexpr float kPlaces[17][2] = {
      {0, -0.44F},      {0.02F, -0.46F}, {-0.02F, -0.46F}, {0.04F, -0.45F}, {-0.04F, -0.45F}, {0.11F, -0.32F},
      {-0.11F, -0.32F}, {0.14F, -0.16F}, {-0.14F, -0.16F}, {0.15F, -0.01F}, {-0.15F, -0.01F}, {0.06F, 0.02F},
      {-0.06F, 0.02F},  {0.065F, 0.24F}, {-0.065F, 0.24F}, {0.07F, 0.46F},  {-0.07F, 0.46F}};
  ScriptedPerson person = {x, y, 0.4F * height, height, score, {}, 0};
  for (const auto& place : kPlaces) {
    person.points.insert(person.points.end(), {x + place[0] * height, y + place[1] * height, visibility});
  }
  return person;
}

/// RTMPose: landmark k has its largest scores at columns[k] and rows[k] (of `per_pixel` · side), of this height.
inline OnnxWriter ScriptedRtmPose(int64_t width, int64_t height, int64_t per_pixel, const std::vector<size_t>& columns,
                                  const std::vector<size_t>& rows, float score) {
  const auto count = static_cast<int64_t>(columns.size());
  const auto peaks = [&](int64_t length, const std::vector<size_t>& places) {
    const auto size = static_cast<size_t>(length);
    ScriptedOutput output = {{1, count, length},
                             std::vector<float>(size * columns.size(), 0.0F),
                             std::vector<float>(size * columns.size(), 0.0F)};
    for (size_t k = 0; k < places.size(); ++k) output.fixed[k * size + places[k]] = score;
    return output;
  };
  return ScriptedNetwork({1, 3, height, width}, {peaks(per_pixel * width, columns), peaks(per_pixel * height, rows)});
}

/// Small networks with all kinds of operators, for damage tests and the fuzzer.
inline std::vector<OnnxWriter> SmallOnnxNetworks() {
  std::vector<OnnxWriter> networks;
  OnnxWriter& conv = networks.emplace_back();
  conv.Input("images", {1, 3, 6, 6})
      .Floats("w", {4, 3, 3, 3}, std::vector<float>(108, 0.125F))
      .Floats("b", {4}, {0, 1, 2, 3});
  conv.Node("Conv", {"images", "w", "b"}, {"c"}, {OnnxWriter::Integers("pads", {1, 1, 1, 1})});
  conv.Node("Sigmoid", {"c"}, {"s"}).Node("Mul", {"c", "s"}, {"x"});
  conv.Ints("parts", {2}, {1, 3}).Node("Split", {"x", "parts"}, {"one", "three"}, {OnnxWriter::Integer("axis", 1)});
  conv.Node("MaxPool", {"three"}, {"p"},
            {OnnxWriter::Integers("kernel_shape", {3, 3}), OnnxWriter::Integers("pads", {1, 1, 1, 1})});
  conv.Node("Concat", {"one", "p"}, {"j"}, {OnnxWriter::Integer("axis", 1)});
  conv.Floats("scales", {4}, {1, 1, 2, 2}).Node("Resize", {"j", "", "scales"}, {"r"});
  conv.Ints("flat", {3}, {1, 4, -1}).Node("Reshape", {"r", "flat"}, {"f"}).Output("f");
  OnnxWriter& shapes = networks.emplace_back();
  shapes.opset = 12;
  shapes.Input("images", {-1, 3, 4, 4}).Ints("zero", {}, {0}).Ints("two", {}, {2});
  shapes.Node("Shape", {"images"}, {"s"}).Node("Gather", {"s", "two"}, {"h"});
  shapes.Node("Cast", {"h"}, {"hf"}, {OnnxWriter::Integer("to", 1)}).Floats("half", {}, {0.5F});
  shapes.Node("Mul", {"hf", "half"}, {"q"}).Floats("0", {}, {0}).Floats("1", {}, {1});
  shapes.Node("Range", {"0", "q", "1"}, {"range"});
  shapes.Node("Unsqueeze", {"range"}, {"u"}, {OnnxWriter::Integers("axes", {0})});
  shapes.Node("ReduceMean", {"images"}, {"m"},
              {OnnxWriter::Integers("axes", {2, 3}), OnnxWriter::Integer("keepdims", 0)});
  shapes.Floats("w", {3, 2}, {1, 2, 3, 4, 5, 6}).Node("MatMul", {"m", "w"}, {"y"}).Node("Add", {"y", "u"}, {"z"});
  shapes.Node("Softmax", {"z"}, {"out"}, {OnnxWriter::Integer("axis", 1)});
  shapes.Node("Transpose", {"out"}, {"t"}, {OnnxWriter::Integers("perm", {1, 0})}).Output("t");
  networks.push_back(ScriptedYoloPose({1, 3, 8, 8}, {ScriptedStanding(4, 4, 6, 0.9F, 0.5F)}, 17, 60));
  return networks;
}

}  // namespace bodyloom
