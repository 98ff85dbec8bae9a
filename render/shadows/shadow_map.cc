// SPDX-License-Identifier: Apache-2.0
#include "render/shadows/shadow_map.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/math/direction_bins.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kUnitTolerance = 1e-5;  ///< of lights in float
constexpr int kBorderPx = 2;
constexpr double kHiddenByPixels = 2;  ///< depth change of a face at grazing light over two pixels
constexpr int kSoftnessPoints = 4;     ///< per side

}  // namespace

void ShadowMap::Render(const MatrixX3d& vertices, const MatrixX3i& faces, const Vector3d& towards, int size_px) {
  BODYLOOM_CHECK(std::abs(towards.norm() - 1) < kUnitTolerance, "shadow map: the light's direction has length ",
                 towards.norm(), ", expected 1");
  BODYLOOM_CHECK(vertices.rows() > 0 && size_px > 2 * kBorderPx, "shadow map: ", vertices.rows(), " vertices, ",
                 size_px, " px");
  const Vector3d across = towards.unitOrthogonal();
  light_from_mesh_ << across.transpose(), across.cross(towards).transpose(), -towards.transpose();
  const MatrixX3d in_light = vertices * light_from_mesh_.transpose();
  const Eigen::RowVector3d low = in_light.colwise().minCoeff(), high = in_light.colwise().maxCoeff();
  const Eigen::RowVector3d middle = 0.5 * (low + high);
  camera_.model = CameraModel::kWeakPerspective;
  camera_.width = camera_.height = size_px;
  camera_.scale = (size_px - 1 - 2 * kBorderPx) / std::max(1e-6, (high - low).head<2>().maxCoeff());
  camera_.tx = -middle.x(), camera_.ty = -middle.y();
  camera_.cx = camera_.cy = 0.5 * (size_px - 1);
  seen_.Render(in_light, faces, camera_, {.cull_back_faces = false});
}

bool ShadowMap::ReachesInLight(const Vector3d& p) const {
  Eigen::Vector2d pixel;
  if (!camera_.Project(p, &pixel)) return true;
  const double depth =
      seen_.DepthAt(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
  return p.z() <= depth + kHiddenByPixels * metres_a_pixel();
}

bool ShadowMap::Reaches(const Vector3d& point) const { return ReachesInLight(light_from_mesh_ * point); }

double ShadowMap::ShareReaching(const Vector3d& point, double softness_m) const {
  const Vector3d p = light_from_mesh_ * point;
  int reaching = 0;
  for (int j = 0; j < kSoftnessPoints; ++j) {
    for (int i = 0; i < kSoftnessPoints; ++i) {
      const auto offset = [&](int k) { return softness_m * ((2 * k + 1.0) / kSoftnessPoints - 1); };
      reaching += ReachesInLight(p + Vector3d(offset(i), offset(j), 0)) ? 1 : 0;
    }
  }
  return reaching / static_cast<double>(kSoftnessPoints * kSoftnessPoints);
}

namespace {

constexpr int kDirections = 48, kMapPx = 160;
constexpr double kLift_m = 0.02;

}  // namespace

const std::vector<float>& AmbientOcclusion::Compute(const MatrixX3d& vertices, const MatrixX3f& normals,
                                                    const MatrixX3i& faces) {
  BODYLOOM_CHECK(normals.rows() == vertices.rows(), "openness: ", normals.rows(), " normals for ", vertices.rows(),
                 " vertices");
  ambient_occlusion_.assign(vertices.rows(), 0);
  whole_.assign(vertices.rows(), 0);
  static const DirectionBins directions(kDirections);
  for (int k = 0; k < kDirections; ++k) {
    const Vector3d& towards = directions.direction(k);
    map_.Render(vertices, faces, towards, kMapPx);
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      const Vector3d normal = normals.row(v).transpose().cast<double>();
      const double share = normal.dot(towards);
      if (!(share > 0)) continue;
      whole_[v] += static_cast<float>(share);
      if (map_.Reaches(vertices.row(v).transpose() + kLift_m * normal))
        ambient_occlusion_[v] += static_cast<float>(share);
    }
  }
  for (size_t v = 0; v < ambient_occlusion_.size(); ++v)
    ambient_occlusion_[v] = whole_[v] > 0 ? ambient_occlusion_[v] / whole_[v] : 1;
  return ambient_occlusion_;
}

}  // namespace bodyloom
