// SPDX-License-Identifier: Apache-2.0
#include "render/raster/near_clip.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

/// Keeps the part of the polygon with plane · (x, y, z, 1) >= 0. A crossing is always computed from the corner inside
/// to the corner outside, so the two faces of a shared edge get the same point.
void ClipAtPlane(const Vector4d& plane, ClippedPolygon* polygon) {
  ClippedPolygon kept;
  const auto side = [&](const Vector3d& x) { return plane.head<3>().dot(x) + plane.w(); };
  for (int i = 0; i < polygon->size; ++i) {
    const Vector3d& p = polygon->corners[i];
    const Vector3d& q = polygon->corners[(i + 1) % polygon->size];
    const double side_p = side(p), side_q = side(q);
    if (side_p >= 0) kept.corners[kept.size++] = p;
    if (side_p >= 0 && side_q < 0) {
      kept.corners[kept.size++] = p + (side_p / (side_p - side_q)) * (q - p);
    } else if (side_p < 0 && side_q >= 0) {
      kept.corners[kept.size++] = q + (side_q / (side_q - side_p)) * (p - q);
    }
  }
  *polygon = kept;
}

/// The four planes that bound |x_px| and |y_px| by the guard band (less a pixel for rounding).
std::array<Vector4d, 4> GuardPlanes(const Camera& camera, double guard_px) {
  const double limit = guard_px - 1;
  if (camera.model == CameraModel::kWeakPerspective) {
    const double s = camera.scale, x = s * camera.tx + camera.cx, y = s * camera.ty + camera.cy;
    return {Vector4d(s, 0, 0, limit + x), Vector4d(-s, 0, 0, limit - x), Vector4d(0, s, 0, limit + y),
            Vector4d(0, -s, 0, limit - y)};
  }
  return {Vector4d(camera.fx, 0, camera.cx + limit, 0), Vector4d(-camera.fx, 0, limit - camera.cx, 0),
          Vector4d(0, camera.fy, camera.cy + limit, 0), Vector4d(0, -camera.fy, limit - camera.cy, 0)};
}

}  // namespace

ClippedPolygon ClipTriangle(const std::array<Vector3d, 3>& corners, const Camera& camera, double near_m,
                            double guard_px) {
  ClippedPolygon polygon;
  polygon.size = 3;
  for (int c = 0; c < 3; ++c) polygon.corners[c] = corners[c];
  if (camera.model == CameraModel::kPinhole) {
    // Clipped corners must satisfy z >= near_m despite rounding.
    ClipAtPlane(Vector4d(0, 0, 1, -near_m * (1 + 1e-9)), &polygon);
  }
  if (camera.HasDistortion()) return polygon;
  for (const Vector4d& plane : GuardPlanes(camera, guard_px)) {
    if (polygon.size == 0) break;
    ClipAtPlane(plane, &polygon);
  }
  return polygon;
}

}  // namespace bodyloom
