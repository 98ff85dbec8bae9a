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

/// Limits oneDNN to one thread during its lifetime. oneDNN divides its work among OpenMP's threads when a primitive is
/// made and when it runs. With one thread several networks can run side by side, and equal inputs give equal bits.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

/// Operators applied to the result in place, in this order.
struct FusedOperators {
  bool sum = false;    ///< of a convolution: adds the previous content of the result's memory
  bool swish = false;  ///< of a convolution: x / (1 + exp(−x))
  std::optional<std::pair<float, float>> clip;
};

/// Made once for inputs of known shapes; constants are kept in the layout that is fastest for the processor. Several
/// threads may run one at once, each with a memory of its own.
class OnednnOperator {
 public:
  /// Reusable per-thread state of an operator: oneDNN views that are bound to the numbers of each run.
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

  /// Number of the node's inputs, from the first, that Run() takes; the others are constants stored in the operator.
  [[nodiscard]] size_t num_inputs() const { return num_inputs_; }
  [[nodiscard]] const std::vector<int64_t>& shape() const { return shape_; }
  /// Computes the result in `target`, which holds as many numbers; for FusedOperators::sum it contains the summand.
  [[nodiscard]] GraphTensor Run(std::span<const GraphTensor* const> inputs, const NewNumbers<float>& target,
                                Memory* memory, FloatPool* pool) const;

 private:
  /// Arguments that are not inputs.
  enum Place { kConstant = -1, kScratch = -2, kResult = -3, kSource = -4, kTarget = -5 };
  struct Argument {
    int role;  ///< DNNL_ARG_SRC …
    dnnl::memory::desc desc;
    int place;  ///< index of an input, or a Place
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
  void MakeTranspose(const OperatorArguments& arguments);
  /// Elementwise, for any shape.
  void MakeSigmoid(const OperatorArguments& arguments);
  void MakeSum(const OperatorArguments& arguments, const FusedOperators& fused);

  size_t num_inputs_ = 1;
  std::vector<std::vector<int64_t>> input_shapes_;
  std::vector<int64_t> shape_;
  std::vector<Primitive> primitives_;
  size_t scratch_bytes_ = 0, source_bytes_ = 0, target_bytes_ = 0;  ///< of temporary memory during a run
};

}  // namespace bodyloom
