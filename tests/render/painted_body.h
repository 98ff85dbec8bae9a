// SPDX-License-Identifier: Apache-2.0
/// Images of a body painted by a formula, with known colour at every surface point.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "geometry/body/body_model.h"
#include "render/image/image.h"
#include "render/raster/visible_points.h"

namespace bodyloom {

/// Smooth waves over the template, each channel within 0.2 to 0.8.
inline Eigen::Vector3d PaintAt(const BodyModel& body, int face, const Eigen::Vector3d& barycentric) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) p += barycentric[k] * body.data().v_template.row(body.data().faces(face, k)).transpose();
  return {0.5 + 0.3 * std::sin(9 * p.x() + 4 * p.y()), 0.5 + 0.3 * std::sin(8 * p.y() - 3 * p.z()),
          0.5 + 0.3 * std::cos(10 * p.z() + 5 * p.x())};
}

/// Image seen by `camera`; the background has a colour that the paint never has.
inline Image PaintedImage(const BodyModel& body, const MatrixX3d& vertices, const Camera& camera) {
  VisibilityBuffer buffer;
  buffer.Render(vertices, body.data().faces, camera);
  const VisiblePoints points = ResolveVisiblePoints(buffer, body, vertices, camera);
  Image image(camera.width, camera.height, Colour{255, 0, 255});
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d bgr = PaintAt(body, points.face[i], points.barycentric[i]);
    for (int c = 0; c < 3; ++c) {
      image.pixel(points.x[i], points.y[i])[c] = static_cast<uint8_t>(std::lround(255 * bgr[c]));
    }
  }
  return image;
}

}  // namespace bodyloom
