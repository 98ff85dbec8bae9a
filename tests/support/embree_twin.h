// SPDX-License-Identifier: Apache-2.0
/// Embree's ray tracer: an independent reference for the visibility buffer, and the alternative that benchmarks compare
/// with. Requires Debian's libembree-dev.
///
/// Embree works in float, on rays through pixel centres; the visibility buffer rounds corners to 1/256 px, so the two
/// may differ near edges. Rule of every comparison: a pixel is compared when its centre is farther than `margin_px`
/// from every edge of both faces (the buffer's and Embree's), as projected without rounding; there the ids must be
/// equal, unless the two depths agree to 1e-5 (surfaces that pass through each other).
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// A scene of one mesh, set up as for a new frame each time: dynamic, robust, built fast.
class EmbreeTwin {
 public:
  explicit EmbreeTwin(const MatrixX3i& faces) : device_(rtcNewDevice("threads=1")), faces_(faces) {
    if (device_ == nullptr) throw std::runtime_error("Embree: no device");
  }
  ~EmbreeTwin() { rtcReleaseDevice(device_); }
  EmbreeTwin(const EmbreeTwin&) = delete;
  EmbreeTwin& operator=(const EmbreeTwin&) = delete;

  /// Rebuilds the tree and casts a packet of rays a stretch of eight pixels; faces and depths of the whole image.
  void See(const MatrixX3d& vertices, const Camera& camera, double near_m) {
    Build(vertices);
    const int width = camera.width, height = camera.height;
    face.assign(size_t(width) * height, -1);
    depth.assign(face.size(), std::numeric_limits<float>::infinity());
    const bool weak = camera.model == CameraModel::kWeakPerspective;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(32) RTCRayHit8 rays;
    alignas(32) int valid[8];
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; x += 8) {
        for (int i = 0; i < 8; ++i) {
          valid[i] = x + i < width ? -1 : 0;
          const Eigen::Vector2d ray = camera.HasDistortion() || weak ? camera.Unproject(Eigen::Vector2d(x + i, y))
                                                                     : Eigen::Vector2d((x + i - camera.cx) / camera.fx,
                                                                                       (y - camera.cy) / camera.fy);
          rays.ray.org_x[i] = weak ? static_cast<float>(ray.x()) : 0;
          rays.ray.org_y[i] = weak ? static_cast<float>(ray.y()) : 0;
          rays.ray.org_z[i] = 0;
          rays.ray.dir_x[i] = weak ? 0 : static_cast<float>(ray.x());
          rays.ray.dir_y[i] = weak ? 0 : static_cast<float>(ray.y());
          rays.ray.dir_z[i] = 1;  // so that the distance is z
          rays.ray.tnear[i] = static_cast<float>(near_m);
          rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
          rays.ray.time[i] = 0;
          rays.ray.mask[i] = ~0U;
          rays.ray.flags[i] = 0;
          rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect8(valid, scene_, &context, &rays);
        for (int i = 0; i < 8 && x + i < width; ++i) {
          if (rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
          face[size_t(y) * width + x + i] = static_cast<int>(rays.hit.primID[i]);
          depth[size_t(y) * width + x + i] = rays.ray.tfar[i];
        }
      }
    }
    rtcReleaseScene(scene_);
  }

  std::vector<int> face;     ///< −1: nothing
  std::vector<float> depth;  ///< metres

 private:
  void Build(const MatrixX3d& vertices) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), vertices.rows()));
    std::copy(vertices.data(), vertices.data() + vertices.size(), points);
    auto* corners = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), faces_.rows()));
    std::copy(faces_.data(), faces_.data() + faces_.size(), corners);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_);
  }

  RTCDevice device_;
  RTCScene scene_ = nullptr;
  MatrixX3i faces_;
};

/// Distance of a pixel's centre from the nearest edge of a projected face, pixels; 0 when a corner does not project.
inline double DistanceToEdges(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, int face, int x,
                              int y) {
  Eigen::Vector2d corner[3];
  for (int c = 0; c < 3; ++c) {
    if (!camera.Project(vertices.row(faces(face, c)).transpose(), &corner[c])) return 0;
  }
  double minimum = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector2d &p = corner[c], q = corner[(c + 1) % 3], at(x, y);
    const Eigen::Vector2d along = q - p;
    const double share = along.squaredNorm() > 0 ? std::clamp((at - p).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    minimum = std::min(minimum, (at - p - share * along).norm());
  }
  return minimum;
}

}  // namespace bodyloom
