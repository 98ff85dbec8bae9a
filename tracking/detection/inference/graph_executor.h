// SPDX-License-Identifier: Apache-2.0
/// Runs a graph of operators (graph.h) on the processor: networks from files and image U-Nets.
///
/// Operators: operators.h, onednn_operator.h, Identity and Dropout, which cover BlazePose, the usual exports of
/// YOLOv8-pose, YOLO11-pose and RTMPose (operator sets 7 to 22) and image U-Nets. Results agree with other runtimes' to
/// rounding. Optimisations:
///   nodes that no wanted output needs  are dropped
///   images whose channels come first   have them last in between (channels_last.h)
///   nodes of constant inputs only      are computed once
///   Pad of rows and columns            becomes the padding of the convolutions behind it
///   x · sigmoid(x), Clip               are done by the convolution or the sum whose result they alone take
///   Add of a convolution's result      to a tensor that is not read later is done by the convolution, in place
///   intermediate tensors               share memory when they are not needed at the same time
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "tracking/detection/inference/graph.h"

namespace bodyloom {

/// Any number of threads may run one at once; each run uses only the calling thread. Copies share one executor. Equal
/// inputs give equal bits.
class GraphExecutor {
 public:
  /// For inputs of `input_shape`, which must equal the graph's except where that is dynamic (−1); none: the graph's.
  /// Computes the graph's outputs with the indices `wanted_outputs`; none: all. The graph need not outlive it. Throws
  /// std::runtime_error "path: node 'name' (operator): what was found, expected what" for an operator that is not known
  /// or not supported in this use, std::invalid_argument for a shape that does not match the graph's, an output that
  /// does not exist and a graph of other than one input.
  explicit GraphExecutor(const OperatorGraph& graph, std::vector<int64_t> input_shape = {},
                         const std::vector<int>& wanted_outputs = {});

  [[nodiscard]] const std::vector<int64_t>& input_shape() const;
  [[nodiscard]] const std::vector<std::vector<int64_t>>& output_shapes() const;
  /// Number of operators that run; fused ones count once.
  [[nodiscard]] size_t num_steps() const;

  /// The wanted outputs in their order, all floats; with `num_outputs`, only the first so many, without the operators
  /// that none of them needs. `input` is in C order; with channels last that is the layout of a continuous cv::Mat.
  /// Throws std::invalid_argument for another number of values, or more outputs than are wanted.
  [[nodiscard]] std::vector<GraphTensor> Run(std::vector<float> input, std::optional<int> num_outputs = {}) const;

 private:
  class Program;
  std::shared_ptr<const Program> program_;
};

}  // namespace bodyloom
