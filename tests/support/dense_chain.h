// SPDX-License-Identifier: Apache-2.0
/// A linearised chain as one dense system, for comparison.
#pragma once

#include <Eigen/Core>

#include "geometry/math/arrays.h"
#include "tracking/solvers/chain/chain_problem.h"

namespace bodyloom {

/// The undamped normal equations of a linearised chain of T frames: frames, then shared values.
inline void DenseSystem(ChainProblem& chain, int T, Eigen::MatrixXd* H, Eigen::VectorXd* g) {
  const int n = chain.frame_size(), s = chain.shared_size(), N = T * n + s, a = chain.arrow_size(), m = a - s;
  Eigen::MatrixXd far(m, N);  // rows of couplings between frames that are not neighbours
  far.rightCols(s) = chain.Arrow(Eigen::VectorXd::Zero(s)).block(s, 0, m, s);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(T * n);
  chain.SetDamping(&none);
  H->setZero(N, N);
  g->resize(N);
  *g << chain.gradient(), chain.shared_gradient();
  for (int t = 0; t < T; ++t) {
    RowMatrixXd A = RowMatrixXd::Zero(n, n), B = RowMatrixXd::Zero(n, a + 1);
    chain.AddFrame(t, A.data(), n, B.data(), a + 1);
    far.middleCols(t * n, n) = B.middleCols(s, m).transpose();
    H->block(t * n, t * n, n, n) = A.selfadjointView<Eigen::Upper>();
    H->block(t * n, T * n, n, s) = B.leftCols(s);
    for (int k = 1; k < 3 && t + k < T; ++k) {
      const double* blocks = k == 1 ? chain.Next(t) : chain.Second(t);
      for (int i = 0; i < n; i += 3, blocks += 9) {
        H->block<3, 3>(t * n + i, (t + k) * n + i) +=
            Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(blocks);
      }
    }
    if (t + 1 < T && chain.DenseNext(t) != nullptr) {
      H->block(t * n, (t + 1) * n, n, n) += Eigen::Map<const RowMatrixXd>(chain.DenseNext(t), n, n);
    }
  }
  H->bottomRightCorner(s, s) = chain.shared().selfadjointView<Eigen::Lower>();
  *H = Eigen::MatrixXd(H->selfadjointView<Eigen::Upper>()) + far.transpose() * far;
  chain.SetDamping(nullptr);
}

}  // namespace bodyloom
