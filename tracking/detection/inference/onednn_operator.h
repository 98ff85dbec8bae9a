// SPDX-License-Identifier: Apache-2.0
/// Operators of graphs (graph.h) that run on oneDNN: Conv, MaxPool, Resize, Upsample, Sigmoid, and Add of two tensors
/// of one shape.
#pragma once

#include <omp.h>

#include <dnnl.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tracking/detection/inference/operators.h"

namespace bodyloom {

/// oneDNN cuts its work for as many threads as OpenMP would give this thread, when a primitive is made and when it
/// runs. While one of these lives that is one: several networks in several threads share the processor, and equal
/// inputs give equal bits.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

/// What an operator does to its result where that is, in this order.
struct FusedOperators {
  bool sum = false;    ///< of a convolution: adds what is in the result's memory before
  bool swish = false;  ///< of a convolution: x / (1 + exp(−x))
  std::optional<std::pair<float, float>> clip;
};

/// Made once for inputs of known shapes; constants are kept in the order that the processor likes. Several threads may
/// run one at once, each with a memory of its own.
class OnednnOperator {
 public:
  /// What one thread needs to run an operator over and over: views of the numbers that come by.
  struct Memory {
    struct Bound {
      std::vector<dnnl::memory> views;
      std::vector<dnnl_exec_arg_t> arguments;
    };
    std::vector<Bound> primitives;
  };

  /// None when the operator is not one of these. Throws std::runtime_error when its inputs do not fit each other or are
  /// not constant where they must be (`is_constant` of each input).
  static std::optional<OnednnOperator> Make(const OperatorArguments& arguments, const std::vector<bool>& is_constant,
                                            const FusedOperators& fused);

  /// The shape that Conv gives. Throws std::runtime_error when image and kernel do not fit each other.
  static std::vector<int64_t> ConvolvedShape(const OperatorArguments& arguments);

  /// How many of the node's first inputs Run() takes; the others are constants that are in here.
  [[nodiscard]] size_t num_inputs() const { return num_inputs_; }
  [[nodiscard]] const std::vector<int64_t>& shape() const { return shape_; }
  /// The result. It is written to `target`, which holds as many numbers, or is the summand of FusedOperators::sum.
  [[nodiscard]] GraphTensor Run(std::span<const GraphTensor* const> inputs, const NewNumbers<float>& target,
                                Memory* memory, FloatPool* pool) const;

 private:
  /// In place of an input's number.
  enum Place { kConstant = -1, kScratch = -2, kResult = -3, kSource = -4, kTarget = -5 };
  struct Argument {
    int role;  ///< DNNL_ARG_SRC …
    dnnl::memory::desc desc;
    int place;  ///< an input, or a Place
    dnnl::memory constant;
  };
  struct Primitive {
    dnnl::primitive primitive;
    std::vector<Argument> arguments;
  };

  void Add(dnnl::primitive primitive, const dnnl::memory::desc& scratch, std::vector<Argument> arguments);
  void AddReorder(const dnnl::memory::desc& from, int source, const dnnl::memory::desc& to, int target);
  void MakeConvolution(const OperatorArguments& arguments, const FusedOperators& fused);
  void MakePool(const OperatorArguments& arguments);
  void MakeResize(const OperatorArguments& arguments);
  /// Of any shape, number by number.
  void MakeSigmoid(const OperatorArguments& arguments);
  void MakeSum(const OperatorArguments& arguments, const FusedOperators& fused);

  size_t num_inputs_ = 1;
  std::vector<std::vector<int64_t>> input_shapes_;
  std::vector<int64_t> shape_;
  std::vector<Primitive> primitives_;
  size_t scratch_bytes_ = 0, source_bytes_ = 0, target_bytes_ = 0;  ///< of what lives during a run
};

}  // namespace bodyloom
