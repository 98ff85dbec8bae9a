// SPDX-License-Identifier: Apache-2.0
/// The robust kernel of every image observation: Geman–McClure, ρ(s) = c² s / (c² + s) for s = squared whitened
/// residual. Quadratic near zero, saturates at c², so that the cost of an outlier, or of a point that cannot be
/// projected, is bounded. Source: Geman & McClure 1987; the form of SMPLify (Bogo et al. 2016).
#pragma once

namespace bodyloom {

struct RobustValue {
  double rho = 0;     ///< ρ(s)
  double weight = 1;  ///< ρ′(s), in (0, 1]
};

/// c > 0 in units of the residual's standard deviation.
inline RobustValue GemanMcClure(double s, double c) {
  const double c2 = c * c, ratio = c2 / (c2 + s);
  return {s * ratio, ratio * ratio};
}

}  // namespace bodyloom
