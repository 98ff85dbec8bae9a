// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body/mean_pelvis.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

Eigen::Vector3d MeanPelvis(const std::string& body) {
  if (body == "smpl") return {-0.0018, -0.2233, 0.0282};
  BODYLOOM_CHECK(body == "smplx", "the pelvis of a body '", body, "', expected smpl or smplx");
  return {0.0031, -0.3514, 0.0120};
}

}  // namespace bodyloom
