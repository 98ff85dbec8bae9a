// SPDX-License-Identifier: Apache-2.0
/// A network of a TensorFlow Lite file as steps of oneDNN: what TfliteNetwork (tflite_network.h) runs.
#pragma once

#include <dnnl.hpp>
#include <functional>
#include <vector>

#include "tracking/detection/inference/tflite_model.h"

namespace bodyloom {

/// In place of a buffer's number.
inline constexpr int kTfliteConstant = -1, kTfliteScratch = -2;

/// One thing that runs: a primitive of oneDNN, or a rearrangement of numbers.
struct TfliteStep {
  struct Argument {
    int role = 0;  ///< DNNL_ARG_SRC …
    dnnl::memory::desc desc;
    int buffer = kTfliteConstant;
    dnnl::memory constant;
  };
  dnnl::primitive primitive;
  std::vector<Argument> arguments;
  /// Instead of a primitive: reads buffers[sources], writes buffers[target].
  std::function<void(const std::vector<const float*>&, float*)> rearrange;
  std::vector<int> sources;
  int target = -1;
};

/// What networks in several threads share: primitives and kernels, nothing that a run changes.
struct TfliteProgram {
  dnnl::engine engine{dnnl::engine::kind::cpu, 0};
  std::vector<TfliteStep> steps;
  std::vector<size_t> buffers;  ///< floats of each
  size_t scratch_bytes = 0;
  std::vector<int> input_shape;
  int input = 0;  ///< its buffer
  struct Output {
    std::vector<int> shape;
    int buffer = 0;
  };
  std::vector<Output> outputs;
  int num_operators = 0;
};

/// The steps of the operators that the wanted tensors need, padding and sums taken into convolutions and buffers shared
/// as tflite_network.h says. The model's one input is an image 1×H×W×C; the caller has checked it. The program does not
/// refer to the model. To be called, and run, under OneThread.
TfliteProgram CompileTflite(const TfliteModel& model, const std::vector<int>& wanted_tensors);

}  // namespace bodyloom
