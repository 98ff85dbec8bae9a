// SPDX-License-Identifier: Apache-2.0
/// Row-major dynamic arrays used throughout: one row per item, so that row data is contiguous and matches .npy C order.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstring>
#include <memory>
#include <new>

namespace bodyloom {

using MatrixX3d = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using MatrixX3f = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using MatrixX2d = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using MatrixX2f = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
using MatrixX3i = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
using RowMatrixXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowMatrixXf = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Matrix2x3d = Eigen::Matrix<double, 2, 3>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// Arrays of floats aligned to a cache line, as the SIMD loops require.

struct AlignedDelete {
  void operator()(float* p) const { ::operator delete[](p, std::align_val_t(64)); }
};
using AlignedFloats = std::unique_ptr<float[], AlignedDelete>;

/// n zeros.
inline AlignedFloats ZeroFloats(size_t n) {
  AlignedFloats result(static_cast<float*>(::operator new[](n * sizeof(float), std::align_val_t(64))));
  std::memset(result.get(), 0, n * sizeof(float));
  return result;
}

}  // namespace bodyloom
