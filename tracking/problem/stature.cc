// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/stature.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double AssumedStature(const TrackSequenceInput& input) {
  VectorXd gradient;
  return input.stature_m > 0 ? input.stature_m : StatureOfMeanShape(*input.body, 0, &gradient);
}

VectorXd SizeDirection(const BodyModel& model, int num_betas) {
  const Eigen::Index V = model.num_vertices();
  MatrixXd S = model.data().shapedirs.leftCols(num_betas).cast<double>();
  MatrixX3d size = model.data().v_template;
  size.rowwise() -= size.colwise().mean().eval();
  for (int b = 0; b < num_betas; ++b) {
    Eigen::Map<RowMatrixXd> moved(S.col(b).data(), V, 3);
    moved.rowwise() -= moved.colwise().mean().eval();
  }
  VectorXd target(3 * V);
  for (Eigen::Index v = 0; v < V; ++v) target.segment<3>(3 * v) = size.row(v).transpose();
  MatrixXd H = S.transpose() * S;
  H.diagonal().array() += 1e-6 * H.trace() / std::max(1, num_betas);
  return H.ldlt().solve(S.transpose() * target);
}

VectorXd WithStature(const BodyModel& model, const VectorXd& betas, double stature_m) {
  const int num_betas = static_cast<int>(betas.size());
  if (num_betas == 0) return betas;
  VectorXd gradient;
  const double mean = StatureOfMeanShape(model, num_betas, &gradient);
  const VectorXd size = SizeDirection(model, num_betas);
  const double by_size = gradient.dot(size);
  if (!(std::abs(by_size) > 1e-3 * mean)) return betas;
  return betas + (stature_m - mean - gradient.dot(betas)) / by_size * size;
}

}  // namespace bodyloom
