// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/nonnegative_least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

Eigen::VectorXd SolveNonnegative(const Eigen::MatrixXd& AtA, const Eigen::VectorXd& Atb) {
  const Eigen::Index n = Atb.size();
  BODYLOOM_CHECK(AtA.rows() == n && AtA.cols() == n, "AtA is ", AtA.rows(), "x", AtA.cols(), ", expected ", n, "x", n);
  BODYLOOM_CHECK(AtA.allFinite() && Atb.allFinite(), "normal equations hold NaN or infinite values");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<bool> is_free(n, false);
  const double tolerance = 1e-10 * std::max(1e-300, Atb.cwiseAbs().maxCoeff());

  const auto solve_free = [&](std::vector<Eigen::Index>* free) {
    free->clear();
    for (Eigen::Index i = 0; i < n; ++i) {
      if (is_free[i]) free->push_back(i);
    }
    const Eigen::MatrixXd sub = AtA(*free, *free);
    return Eigen::VectorXd(sub.ldlt().solve(Atb(*free)));
  };
  std::vector<Eigen::Index> free;
  for (Eigen::Index outer = 0; outer < 3 * n; ++outer) {
    const Eigen::VectorXd descent = Atb - AtA * x;
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_free[i] && descent[i] > tolerance && (best < 0 || descent[i] > descent[best])) best = i;
    }
    if (best < 0) break;
    is_free[best] = true;
    // Walk to the free optimum, dropping the variables that would turn negative on the way.
    for (Eigen::VectorXd target = solve_free(&free); !free.empty(); target = solve_free(&free)) {
      double step = 1;
      for (size_t k = 0; k < free.size(); ++k) {
        const double from = x[free[k]], to = target[static_cast<Eigen::Index>(k)];
        if (to <= 0) step = std::min(step, from / (from - to));
      }
      for (size_t k = 0; k < free.size(); ++k) {
        double& value = x[free[k]];
        value += step * (target[static_cast<Eigen::Index>(k)] - value);
      }
      if (step >= 1) break;
      for (Eigen::Index i : free) {
        if (x[i] <= 1e-15) {
          x[i] = 0;
          is_free[i] = false;
        }
      }
    }
  }
  return x;
}

}  // namespace bodyloom
