// SPDX-License-Identifier: Apache-2.0
/// Runs a graph of operators (graph.h) on the processor: the one engine for networks of files and for picture U-Nets.
///
/// Operators: operators.h, onednn_operator.h, Identity and Dropout: those that BlazePose, the usual exports of
/// YOLOv8-pose, YOLO11-pose and RTMPose (operator sets 7 to 22) and picture U-Nets have. Results agree with other
/// runtimes' to rounding.
///   what no wanted output needs        is left out
///   what hangs on constants alone      is computed once
///   Pad of rows and columns            becomes the padding of the convolutions behind it
///   x · sigmoid(x), Clip               are done by the convolution or the sum whose result they alone take
///   Add of a convolution's result      to a tensor that nobody reads later is done by the convolution, in place
///   intermediate tensors               share memory when they are not needed at the same time
#pragma once

#include <memory>
#include <vector>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// Any number of threads may run one at once, each on its own thread alone; copies are the same executor. Equal inputs
/// give equal bits.
class GraphExecutor {
 public:
  /// For inputs of that shape, which is the graph's but where that is dynamic (−1); none: the graph's. Gives the wanted
  /// ones of the graph's outputs, by their places among them; none: all. The graph need not outlive it. Throws
  /// std::runtime_error "path: node 'name' (operator): what was found, expected what" for an operator that is not known
  /// or not in this use, std::invalid_argument for a shape that is not the graph's, an output that is not there and for
  /// a graph of other than one input.
  explicit GraphExecutor(const OperatorGraph& graph, std::vector<int64_t> input_shape = {},
                         const std::vector<int>& wanted_outputs = {});

  [[nodiscard]] const std::vector<int64_t>& input_shape() const;
  [[nodiscard]] const std::vector<std::vector<int64_t>>& output_shapes() const;
  /// How many operators run, several as one where that is said above.
  [[nodiscard]] size_t num_steps() const;

  /// The wanted outputs in their order, all floats. `input` is in C order, as an image is in a continuous cv::Mat where
  /// channels are last. Throws std::invalid_argument for another number.
  [[nodiscard]] std::vector<GraphTensor> Run(std::vector<float> input) const;

 private:
  class Program;
  std::shared_ptr<const Program> program_;
};

}  // namespace bodyloom
