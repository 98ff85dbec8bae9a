// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/balance/balance.h"

#include "tracking/problem/frame_accumulator.h"

namespace bodyloom {

using Eigen::Vector3d;

void BalanceTerm::Add(FrameAccumulator* sums) const {
  if (centre_of_mass == nullptr || !(weight > 0)) return;
  const double shares[2] = {share, 1 - share};
  constexpr double kVertexAlone[3] = {1, 0, 0};
  const auto support = [&](int k) {
    const int v[3] = {vertices[k], vertices[k], vertices[k]};
    return sums->points().Evaluate(sums->kinematics(), v, kVertexAlone, &sums->vertices(), sums->derivatives());
  };
  // The support is evaluated first, because rows are those of the point evaluated last.
  Vector3d s = Vector3d::Zero();
  for (const int k : {0, 1}) s += shares[k] * support(k);
  const Vector3d c = sums->points().Evaluate(sums->kinematics(), *centre_of_mass, sums->derivatives());
  const Eigen::Vector2d residual = horizontal * (c - s + offset_m) / sigma_m;
  const double scale = sums->AddGroup(2, residual.squaredNorm(), kBalanceKernel, weight);
  if (!sums->derivatives()) return;
  auto rows = sums->NextRows(8);
  const Eigen::Matrix<double, 2, 3> factor = scale / sigma_m * horizontal;
  sums->FillPointRows(rows.topRows<3>());
  sums->DependsOnPoint();
  RowMatrixXd sum = factor * rows.topRows<3>();
  for (const int k : {0, 1}) {
    support(k);
    sums->FillPointRows(rows.topRows<3>());
    sums->DependsOnPoint();
    sum.noalias() -= shares[k] * factor * rows.topRows<3>();
  }
  rows.topRows<2>() = sum;
  sums->NextResiduals(2) = scale * residual;
  sums->TakeRows(2);
}

}  // namespace bodyloom
