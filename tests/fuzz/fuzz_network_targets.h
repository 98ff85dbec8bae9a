// SPDX-License-Identifier: Apache-2.0
/// Fuzz targets for TensorFlow Lite and ONNX files, and for outputs of detectors' networks. Each returns true if the
/// input was accepted; accepted data must be consistent, and small networks are built and run.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_accepts.h"
#include "tracking/detection/inference/graph_executor.h"
#include "tracking/detection/inference/onnx_reader.h"
#include "tracking/detection/inference/tflite_reader.h"
#include "tracking/detection/keypoint_model.h"

namespace bodyloom::fuzz {

/// Maximum total number of tensor elements of networks that are run.
inline constexpr size_t kSmallNetwork = 20'000;

inline void CheckOutputs(const std::vector<GraphTensor>& outputs) {
  for (const GraphTensor& output : outputs) {
    if (!output.has_floats() || output.floats.size() != output.size()) {
      throw std::logic_error("an output of another size than its shape");
    }
  }
}

inline void CheckNetwork(const OperatorGraph& graph, size_t file_bytes) {
  size_t constants = 0, all = 0;
  for (const OperatorGraph::Tensor& tensor : graph.tensors) {
    constants += tensor.constant.floats.size() * sizeof(float) + tensor.constant.ints.size() * sizeof(int64_t);
    all += GraphShapeSize(tensor.shape);
  }
  if (constants > 16 * file_bytes) throw std::logic_error("constants beyond their bound");
  const size_t size = GraphShapeSize(graph.tensors[size_t(graph.inputs[0])].shape);
  if (graph.inputs.size() != 1 || all > kSmallNetwork) return;
  CheckOutputs(GraphExecutor(graph).Run(std::vector<float>(size, 0.5F)));
}

inline bool AcceptsTflite(const std::string& bytes) {
  OperatorGraph graph;
  if (!Accepts([&] { graph = ParseTfliteGraph(bytes, "fuzz.tflite"); })) return false;
  try {
    CheckNetwork(graph, bytes.size());
  } catch (const std::exception& error) {
    throw std::logic_error(std::string("a network that was accepted: ") + error.what());
  }
  return true;
}

/// An ONNX file that was read is a network or is rejected in one line because its operators do not fit together; one
/// that passed a trial on zeros must run.
inline bool AcceptsOnnx(const std::string& bytes) {
  OperatorGraph graph;
  if (!Accepts([&] { graph = ParseOnnxGraph(bytes, "fuzz.onnx"); })) return false;
  std::vector<int64_t> shape = graph.tensors[size_t(graph.inputs[0])].shape;
  size_t size = 1;
  for (int64_t& n : shape) {
    n = n == -1 ? 1 : n;
    size *= static_cast<size_t>(std::min<int64_t>(n, kSmallNetwork));
    if (size > kSmallNetwork) return true;
  }
  Accepts([&] { CheckOutputs(GraphExecutor(graph, shape).Run(std::vector<float>(size, 0.5F))); });
  return true;
}

inline void CheckPoints(const std::vector<Keypoint>& points) {
  for (const Keypoint& point : points) {
    if (!(point.confidence >= 0 && point.confidence <= 1)) throw std::logic_error("a confidence out of range");
    if (point.confidence > 0 && !(std::isfinite(point.x) && std::isfinite(point.y))) {
      throw std::logic_error("a landmark that is nowhere");
    }
  }
}

/// Any numbers as the output of YOLO-pose with two landmarks, and as RTMPose's for three landmarks in 4 × 6 pixels.
inline bool AcceptsKeypointOutputs(const std::string& bytes) {
  std::vector<float> numbers(bytes.size() / sizeof(float));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(float));
  const size_t rows = 5 + 3 * 2, simcc = 3 * 2 * (4 + 6);
  const std::vector<float> yolo(numbers.begin(), numbers.end() - static_cast<std::ptrdiff_t>(numbers.size() % rows));
  for (const YoloPerson& person : DecodeYolo(yolo, 1, 2, LetterboxCrop(1280, 720, 640, 640))) {
    if (!(person.box.x1 > person.box.x0 && person.box.score >= 0.25 && person.box.score <= 1)) {
      throw std::logic_error("a box that is none");
    }
    CheckPoints(person.points);
  }
  if (numbers.size() < simcc) return false;
  const float* rows_of = numbers.data() + 3 * 2 * 4;
  CheckPoints(DecodeSimcc({numbers.data(), 3 * 2 * 4}, {rows_of, 3 * 2 * 6}, 3, 2, TopDownCrop({1, 2, 5, 9, 1}, 4, 6)));
  return true;
}

}  // namespace bodyloom::fuzz
