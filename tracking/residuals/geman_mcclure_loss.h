// SPDX-License-Identifier: Apache-2.0
/// The robust kernel of robust.h for Ceres' own use: ρ(s) = c² s / (c² + s).
#pragma once

#include <ceres/loss_function.h>

#include "bodyloom/tracking/robust.h"

namespace bodyloom {

class GemanMcClureLoss : public ceres::LossFunction {
 public:
  /// c > 0 in standard deviations.
  explicit GemanMcClureLoss(double c) : c_(c) {}
  void Evaluate(double s, double rho[3]) const override {
    const RobustValue value = GemanMcClure(s, c_);
    rho[0] = value.rho;
    rho[1] = value.weight;
    rho[2] = -2 * value.weight / (c_ * c_ + s);
  }

 private:
  double c_;
};

}  // namespace bodyloom
