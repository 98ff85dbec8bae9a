// SPDX-License-Identifier: Apache-2.0
/// The fuzzer's function for networks of TensorFlow Lite's files. It returns whether the input was accepted; what is
/// accepted must hold together: small networks are built and run too, on which OpenCV must not stumble.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "bodyloom/data_tools/detection/tflite_network.h"
#include "tests/fuzz/fuzz_accepts.h"

namespace bodyloom::fuzz {

/// Numbers of all tensors together up to which a network is run.
inline constexpr size_t kSmallNetwork = 20'000;

inline void CheckNetwork(const TfliteModel& model, size_t file_bytes) {
  size_t constants = 0, all = 0;
  for (const TfliteTensor& tensor : model.tensors) {
    constants += tensor.values().size_bytes() + tensor.ints.size() * sizeof(int32_t);
    all += tensor.size();
  }
  if (constants > 16 * file_bytes) throw std::logic_error("constants beyond their bound");
  const std::vector<int>& shape = model.tensors[static_cast<size_t>(model.inputs[0])].shape;
  if (model.inputs.size() != 1 || shape.size() != 4 || shape[0] != 1 || all > kSmallNetwork) return;
  TfliteNetwork network(model);
  const std::vector<float> input(model.tensors[static_cast<size_t>(model.inputs[0])].size(), 0.5F);
  for (const TfliteValues& output : network.Run(input)) {
    size_t size = 1;
    for (const int n : output.shape) size *= static_cast<size_t>(n);
    if (output.values.size() != size) throw std::logic_error("an output of another size than its shape");
  }
}

inline bool AcceptsTflite(const std::string& bytes) {
  TfliteModel model;
  if (!Accepts([&] { model = ParseTfliteModel(bytes, "fuzz.tflite"); })) return false;
  try {
    CheckNetwork(model, bytes.size());
  } catch (const std::exception& error) {
    throw std::logic_error(std::string("a network that was accepted: ") + error.what());
  }
  return true;
}

}  // namespace bodyloom::fuzz
