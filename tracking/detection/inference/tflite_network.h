// SPDX-License-Identifier: Apache-2.0
/// Runs a network of a TensorFlow Lite file with oneDNN.
///
/// Images stay in TFLite's order of memory (N×H×W×C), so that RESHAPE, CONCATENATION and DEPTH_TO_SPACE only copy.
///   PAD of rows and columns   becomes the padding of the convolutions behind it
///   ADD                       of a convolution's result to a tensor that nobody reads later is done by the
///   convolution,
///                             in place; so is relu6
///   intermediate tensors      share buffers when they are not needed at the same time
/// Results agree with TensorFlow Lite's own to rounding.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "tracking/detection/inference/tflite_model.h"

namespace bodyloom {

/// Numbers in TFLite's memory order: the last axis (channels of an image) is the fastest.
struct TfliteValues {
  std::vector<int> shape;
  std::vector<float> values;
};

/// One object is used by one thread at a time, and runs on that thread alone. Several in several threads do not disturb
/// each other; copies share the kernels, nearly all of the memory. Equal inputs give equal bits.
class TfliteNetwork {
 public:
  /// The operators that the wanted outputs need; `wanted_outputs` are places among model.outputs, none = all. The model
  /// need not outlive the network. Throws std::invalid_argument for a place that is not there, and for a model with
  /// other than one input of shape 1×H×W×C.
  explicit TfliteNetwork(const TfliteModel& model, const std::vector<int>& wanted_outputs = {});
  TfliteNetwork(const TfliteNetwork& other);
  TfliteNetwork& operator=(const TfliteNetwork&) = delete;
  ~TfliteNetwork();
  TfliteNetwork(TfliteNetwork&&) noexcept;
  TfliteNetwork& operator=(TfliteNetwork&&) noexcept;

  /// 1×H×W×C.
  [[nodiscard]] const std::vector<int>& input_shape() const;
  /// How many of the model's operators run.
  [[nodiscard]] int num_operators() const;

  /// The wanted outputs in their order. `input` holds H·W·C numbers, row after row, channels together (the memory of a
  /// continuous cv::Mat of type CV_32FC3; colours in RGB order), in the range the network was trained with. Throws
  /// std::invalid_argument for another number.
  std::vector<TfliteValues> Run(std::span<const float> input);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
