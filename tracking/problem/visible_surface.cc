// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/visible_surface.h"

namespace bodyloom {

bool VisibleSurface::Render(const std::shared_ptr<const Skinner>& skinner, const BodyModel& model,
                            const Eigen::VectorXd& betas, const std::vector<Eigen::Matrix3d>& rotations,
                            const Eigen::Vector3d& translation, const Camera& camera) {
  if (camera.width <= 0 || camera.height <= 0 || !betas.allFinite()) return false;
  if (skinner_ != skinner || betas_.size() != betas.size() || betas_ != betas) {
    skinner_ = skinner;
    betas_ = betas;
    shaped_ = skinner->Shape(betas);
  }
  pose_.rotations = rotations;
  pose_.trans = translation;
  vertices_.resize(model.num_vertices(), 3);
  skinner->Skin(shaped_, {&pose_, 1}, {vertices_.data(), static_cast<size_t>(vertices_.size())});
  if (!vertices_.allFinite()) return false;
  buffer_.Render(vertices_, model.data().faces, camera);
  return true;
}

}  // namespace bodyloom
