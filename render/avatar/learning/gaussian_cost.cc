// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/learning/gaussian_cost.h"

#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

double AddGaussianCost(const GaussianBody& body, const GaussianCost& cost, FloatColumns* gradient) {
  const FloatColumns& p = body.parameters;
  BODYLOOM_CHECK(gradient->rows() == p.rows() && gradient->columns() == p.columns(), "Gaussians' cost: derivatives of ",
                 gradient->rows(), " rows, expected ", p.rows());
  const int count = body.size();
  if (count == 0) return 0;
  const float by_scale = cost.by_scale / static_cast<float>(count);
  double opacities = 0, scales = 0;
  for (int i = 0; i < count; ++i) {
    const float opacity = 1 / (1 + std::exp(-p(i, GaussianBody::kOpacityLogit)));
    if (body.kinds[i] == GaussianKind::kCloth) continue;
    const float by_opacity =
        (cost.by_opacity + cost.by_distance * (1 - body.anchors[i].corrective_factor)) / static_cast<float>(count);
    opacities += by_opacity * opacity;
    (*gradient)(i, GaussianBody::kOpacityLogit) += by_opacity * opacity * (1 - opacity);
  }
  for (int c = GaussianBody::kLogScale; c < GaussianBody::kLogScale + 3; ++c) {
    for (int i = 0; i < count; ++i) {
      const float scale = std::exp(p(i, c));
      scales += scale;
      (*gradient)(i, c) += by_scale * scale;
    }
  }
  return opacities + by_scale * scales;
}

}  // namespace bodyloom
