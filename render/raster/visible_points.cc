// SPDX-License-Identifier: Apache-2.0
#include "render/raster/visible_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Viewing ray: origin + t · direction.
struct Ray {
  Vector3d origin, direction;
};

Ray RayOfPixel(const Camera& camera, const Vector2d& pixel) {
  const Vector2d xy = camera.Unproject(pixel);
  if (camera.model == CameraModel::kWeakPerspective) return {Vector3d(xy.x(), xy.y(), 0), Vector3d::UnitZ()};
  return {Vector3d::Zero(), Vector3d(xy.x(), xy.y(), 1)};
}

/// Signed volumes of the ray with the three edges: b_c ∝ direction · (corner_{c+1} × corner_{c+2}), corners relative to
/// the ray's origin. All three have the sign of the face's orientation if the ray passes inside.
Vector3d BarycentricOnRay(const MatrixX3d& vertices, const MatrixX3i& faces, int face, const Ray& ray) {
  std::array<Vector3d, 3> corner;
  for (int c = 0; c < 3; ++c) corner[c] = vertices.row(faces(face, c)).transpose() - ray.origin;
  Vector3d b;
  for (int c = 0; c < 3; ++c) b[c] = ray.direction.dot(corner[(c + 1) % 3].cross(corner[(c + 2) % 3]));
  const double sum = b.sum();
  if (sum != 0 && b.allFinite()) {
    b /= sum;
    if (b.minCoeff() > -0.5) return b.cwiseMax(0) / b.cwiseMax(0).sum();
  }
  Vector3d distance;
  for (int c = 0; c < 3; ++c) distance[c] = ray.direction.cross(corner[c]).squaredNorm();
  int nearest = 0;
  distance.minCoeff(&nearest);
  return Vector3d::Unit(nearest);
}

}  // namespace

Vector3d BarycentricAtPixel(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, int face,
                            const Vector2d& pixel) {
  BODYLOOM_CHECK(face >= 0 && face < faces.rows(), "face ", face, " is outside 0..", faces.rows() - 1);
  return BarycentricOnRay(vertices, faces, face, RayOfPixel(camera, pixel));
}

Eigen::Vector2f ChartUvAt(const BodyModel& body, int face, const Vector3d& barycentric) {
  const auto corners = body.data().face_iuv.row(face);
  const Eigen::Vector3f b = barycentric.cast<float>();
  return {b[0] * corners[0] + b[1] * corners[2] + b[2] * corners[4],
          b[0] * corners[1] + b[1] * corners[3] + b[2] * corners[5]};
}

VisiblePoints ResolveVisiblePoints(const VisibilityBuffer& buffer, const BodyModel& body, const MatrixX3d& vertices,
                                   const Camera& camera, const VisiblePointsRequest& request) {
  BODYLOOM_CHECK(!request.part || body.has_parts(), "the body '", body.name(), "' has no parts");
  BODYLOOM_CHECK(!request.chart_uv || body.data().face_iuv.rows() > 0, "the body '", body.name(),
                 "' has no chart coordinates");
  BODYLOOM_CHECK(vertices.rows() == body.num_vertices(), "visible points: ", vertices.rows(), " vertices, the body '",
                 body.name(), "' has ", body.num_vertices());
  const MatrixX3i& faces = body.data().faces;
  const PixelBox& box = buffer.box();
  const size_t count = std::count_if(buffer.faces().begin(), buffer.faces().end(), [](int32_t f) { return f >= 0; });
  VisiblePoints points;
  points.x.reserve(count), points.y.reserve(count), points.face.reserve(count), points.barycentric.reserve(count);
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const int face = buffer.faces()[box.IndexOf(x, y)];
      if (face < 0) continue;
      const Vector3d b = BarycentricOnRay(vertices, faces, face, RayOfPixel(camera, Vector2d(x, y)));
      points.x.push_back(x);
      points.y.push_back(y);
      points.face.push_back(face);
      points.barycentric.push_back(b);
      if (request.part) points.part.push_back(body.data().face_part[face]);
      if (request.chart_uv) points.chart_uv.push_back(ChartUvAt(body, face, b));
      if (request.depth) {
        const double z = b[0] * vertices(faces(face, 0), 2) + b[1] * vertices(faces(face, 1), 2) +
                         b[2] * vertices(faces(face, 2), 2);
        points.depth_m.push_back(static_cast<float>(z));
      }
    }
  }
  return points;
}

}  // namespace bodyloom
