// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/flat_gaussian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace bodyloom {

void SetFlatGaussian(const FlatGaussian& gaussian, int row, GaussianBody* body) {
  constexpr double kLeastSigma_m = 1e-5;
  using Body = GaussianBody;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), gaussian.normal);
  const float quaternion[4] = {float(turn.w()), float(turn.x()), float(turn.y()), float(turn.z())};
  FloatColumns& p = body->parameters;
  for (int k = 0; k < 4; ++k) p(row, Body::kQuaternion + k) = quaternion[k];
  for (int k = 0; k < 3; ++k) {
    p(row, Body::kPosition + k) = static_cast<float>(gaussian.place[k]);
    p(row, Body::kNormal + k) = static_cast<float>(gaussian.normal[k]);
    p(row, Body::kLogScale + k) =
        static_cast<float>(std::log(std::max(kLeastSigma_m, gaussian.sigma_m * (k == 2 ? gaussian.flatness : 1))));
    p(row, Body::kAlbedo + k) = gaussian.albedo;
  }
  p(row, Body::kOpacityLogit) = gaussian.opacity_logit;
}

}  // namespace bodyloom
