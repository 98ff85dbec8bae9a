// SPDX-License-Identifier: Apache-2.0
/// The visible surface of the posed body in one frame, for terms that depend on visibility. The body is posed in float
/// by the SIMD skinner (error below 1e-6 m, which affects only the choice of the visible face; residuals are computed
/// in double) and rasterised by the visibility buffer. Keeps its memory and the shaped body between calls, so frames of
/// one shape only need skinning and rasterising. One instance a thread.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/skinning.h"
#include "geometry/scene/camera.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

class VisibleSurface {
 public:
  /// Poses and rasterises the body. Returns false when a value is not finite or the camera has no image size; nothing
  /// is visible then. `translation` is the body's, zero for weak perspective, whose scale and offset are in `camera`.
  /// `skinner` poses all vertices of `model`.
  bool Render(const std::shared_ptr<const Skinner>& skinner, const BodyModel& model, const Eigen::VectorXd& betas,
              const std::vector<Eigen::Matrix3d>& rotations, const Eigen::Vector3d& translation, const Camera& camera);

  /// V×3, camera frame.
  [[nodiscard]] const MatrixX3d& vertices() const { return vertices_; }
  [[nodiscard]] const VisibilityBuffer& buffer() const { return buffer_; }

 private:
  std::shared_ptr<const Skinner> skinner_;  ///< kept, so that another one cannot take its address
  Eigen::VectorXd betas_;
  ShapedBody shaped_;
  BodyPose pose_;
  MatrixX3d vertices_;
  VisibilityBuffer buffer_;
};

}  // namespace bodyloom
