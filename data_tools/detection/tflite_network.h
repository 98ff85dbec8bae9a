// SPDX-License-Identifier: Apache-2.0
/// Runs a network of a TensorFlow Lite file with OpenCV's dnn: the layers are built one by one from the model, as dnn
/// 4.6 reads no .tflite file.
///
/// What differs between the two, beside memory order (N×H×W×C against N×C×H×W):
///   PAD of rows and columns   becomes the padding of the convolutions behind it where that is the same at both ends
///   uneven padding            a Padding layer in front: a convolution of dnn 4.6 throws on it
///   RESHAPE                   transposed to TFLite's order first, and back when the result is an image
///   DEPTH_TO_SPACE            splits channels as (row, column, channel); two reshapes and a transposition
/// Results agree with TensorFlow Lite's own to rounding.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "bodyloom/data_tools/detection/tflite_model.h"

namespace bodyloom {

/// Numbers in TFLite's memory order: the last axis (channels of an image) is the fastest.
struct TfliteValues {
  std::vector<int> shape;
  std::vector<float> values;
};

/// One object is used by one thread at a time; several in several threads do not disturb each other. How many threads
/// dnn itself uses is a setting of the whole process (cv::setNumThreads), which is left as it is: with objects in
/// several threads set it to 1. Equal numbers of threads give equal bits; other numbers cut the convolutions elsewhere
/// and round otherwise (1e-4 of the pose detector's 224 pixels with 3 instead of 1).
class TfliteNetwork {
 public:
  /// The layers that the wanted outputs need; `wanted_outputs` are places among model.outputs, none = all. The kernels
  /// of 1×1 convolutions, nearly all of the memory, are shared with the model and its other networks; the model itself
  /// need not outlive the network. Throws std::invalid_argument for a place that is not there, and for a model with
  /// other than one input of shape 1×H×W×C.
  explicit TfliteNetwork(const TfliteModel& model, const std::vector<int>& wanted_outputs = {});
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
