// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/shadows/openness.h"

#include <Eigen/Core>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/direction_bins.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr int kDirections = 48, kMapPx = 160;
constexpr double kLift_m = 0.02;

}  // namespace

const std::vector<float>& OpennessOfMesh::Compute(const MatrixX3d& vertices, const MatrixX3f& normals,
                                                  const MatrixX3i& faces) {
  BODYLOOM_CHECK(normals.rows() == vertices.rows(), "openness: ", normals.rows(), " normals for ", vertices.rows(),
                 " vertices");
  openness_.assign(vertices.rows(), 0);
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
      if (map_.Reaches(vertices.row(v).transpose() + kLift_m * normal)) openness_[v] += static_cast<float>(share);
    }
  }
  for (size_t v = 0; v < openness_.size(); ++v) openness_[v] = whole_[v] > 0 ? openness_[v] / whole_[v] : 1;
  return openness_;
}

}  // namespace bodyloom
