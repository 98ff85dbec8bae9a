// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <dnnl.hpp>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/operators.h"

namespace bodyloom {
namespace {

/// Computes C = alpha · A · B, row-major.
void Multiply(bool transpose_a, bool transpose_b, int64_t rows, int64_t columns, int64_t inner, float alpha,
              const float* a, const float* b, float* c) {
  if (rows == 0 || columns == 0) return;
  if (inner == 0) {
    std::fill_n(c, rows * columns, 0.0F);
    return;
  }
  const dnnl::status status =
      dnnl::sgemm(transpose_a ? 'T' : 'N', transpose_b ? 'T' : 'N', rows, columns, inner, alpha, a,
                  transpose_a ? rows : inner, b, transpose_b ? inner : columns, 0.0F, c, columns);
  if (status != dnnl::status::success) throw std::runtime_error("a product of matrices failed");
}

}  // namespace

GraphTensor RunMatMul(const OperatorArguments& arguments) {
  GraphTensor a = arguments.FloatInput(0), b = arguments.FloatInput(1);
  if (a.rank() == 0 || b.rank() == 0) throw std::runtime_error("a product with a single number");
  const bool row = a.rank() == 1, column = b.rank() == 1;
  if (row) a = a.Reshaped({1, a.shape[0]});
  if (column) b = b.Reshaped({b.shape[0], 1});
  const int64_t rows = a.shape[size_t(a.rank() - 2)], inner = a.shape.back(), columns = b.shape.back();
  if (b.shape[size_t(b.rank() - 2)] != inner) {
    throw std::runtime_error("a product of " + GraphShapeText(a.shape) + " and " + GraphShapeText(b.shape));
  }
  const std::vector<int64_t> a_batch(a.shape.begin(), a.shape.end() - 2), b_batch(b.shape.begin(), b.shape.end() - 2);
  std::vector<int64_t> shape = BroadcastShape(a_batch, b_batch);
  const size_t batch = GraphShapeSize(shape);
  const auto spread = [&shape](const GraphTensor& tensor, int64_t n, int64_t m) {
    std::vector<int64_t> to = shape;
    to.insert(to.end(), {n, m});
    return BroadcastTo(tensor, to);
  };
  const bool shared = b_batch.empty();  // one matrix for all: one product
  const GraphTensor left = spread(a, rows, inner), right = shared ? b : spread(b, inner, columns);
  shape.insert(shape.end(), {rows, columns});
  std::vector<float> result(GraphShapeSize(shape));
  const size_t products = shared ? 1 : batch;
  const int64_t together = shared ? int64_t(batch) * rows : rows;
  for (size_t i = 0; i < products; ++i) {
    Multiply(false, false, together, columns, inner, 1, left.floats.data() + i * size_t(rows * inner),
             right.floats.data() + i * size_t(inner * columns), result.data() + i * size_t(rows * columns));
  }
  if (row) shape.erase(shape.end() - 2);
  if (column) shape.pop_back();
  return {std::move(shape), std::move(result)};
}

GraphTensor RunGemm(const OperatorArguments& arguments) {
  const GraphTensor &a = arguments.FloatInput(0), &b = arguments.FloatInput(1);
  if (a.rank() != 2 || b.rank() != 2) throw std::runtime_error("other than two matrices");
  const bool turn_a = arguments.node().Integer("transA", 0) != 0, turn_b = arguments.node().Integer("transB", 0) != 0;
  const int64_t rows = a.shape[turn_a ? 1 : 0], inner = a.shape[turn_a ? 0 : 1];
  const int64_t columns = b.shape[turn_b ? 0 : 1];
  if (b.shape[turn_b ? 1 : 0] != inner) {
    throw std::runtime_error("a product of " + GraphShapeText(a.shape) + " and " + GraphShapeText(b.shape));
  }
  std::vector<float> result(GraphShapeSize({rows, columns}));
  Multiply(turn_a, turn_b, rows, columns, inner, arguments.node().Float("alpha", 1), a.floats.data(), b.floats.data(),
           result.data());
  if (arguments.Has(2)) {
    const GraphTensor bias = BroadcastTo(arguments.FloatInput(2), {rows, columns});
    const float beta = arguments.node().Float("beta", 1);
    for (size_t i = 0; i < result.size(); ++i) result[i] += beta * bias.floats[i];
  }
  return {{rows, columns}, std::move(result)};
}

}  // namespace bodyloom
