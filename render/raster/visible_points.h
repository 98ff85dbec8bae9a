// SPDX-License-Identifier: Apache-2.0
/// Visible points of the body, one per covered pixel: the point on the surface and, on request, its part and chart
/// coordinates.
///
/// The point is where the ray through the pixel's centre meets the plane of the face that the visibility buffer found,
/// computed in double from the unrounded vertices: perspective correct, exact for distorted lenses too, and free of the
/// 1/256 px rounding used for visibility. Barycentrics that this rounding leaves outside the face (by less than the
/// rounding) are clamped to it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// Attributes to compute besides face and barycentrics.
struct VisiblePointsRequest {
  bool part = false;      ///< chart id 1..24, 0 where the face has none
  bool chart_uv = false;  ///< (u, v) inside the face's chart
  bool depth = false;     ///< z, metres
};

/// One entry per covered pixel, rows from top to bottom, pixels from left to right. Arrays not requested are empty.
struct VisiblePoints {
  std::vector<int> x, y;  ///< pixel
  std::vector<int> face;
  std::vector<Eigen::Vector3d> barycentric;  ///< of the face's corners, each in [0, 1], sums to 1
  std::vector<uint8_t> part;
  std::vector<Eigen::Vector2f> chart_uv;
  std::vector<float> depth_m;
  [[nodiscard]] size_t size() const { return face.size(); }
};

/// The surface point that `face` shows at `pixel`: barycentrics clamped to the face. For a face seen edge-on, where the
/// intersection is ill-conditioned, its nearest corner is returned.
Eigen::Vector3d BarycentricAtPixel(const MatrixX3d& vertices_in_camera, const MatrixX3i& faces, const Camera& camera,
                                   int face, const Eigen::Vector2d& pixel);

/// Chart coordinates of a surface point: barycentric mean of the face's corners. The body must have face_iuv.
Eigen::Vector2f ChartUvAt(const BodyModel& body, int face, const Eigen::Vector3d& barycentric);

/// Resolves every covered pixel of the buffer. `vertices_in_camera`, the body's faces and `camera` must be those that
/// were rendered. Throws std::invalid_argument when parts or chart coordinates are requested from a body without them.
VisiblePoints ResolveVisiblePoints(const VisibilityBuffer& buffer, const BodyModel& body,
                                   const MatrixX3d& vertices_in_camera, const Camera& camera,
                                   const VisiblePointsRequest& request = {});

}  // namespace bodyloom
