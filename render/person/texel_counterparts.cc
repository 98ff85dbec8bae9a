// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/texel_counterparts.h"

namespace bodyloom {

MatrixX3d TexelPoints(const MatrixX3d& rest_vertices, const MatrixX3i& faces, const UvTexelTable& table) {
  MatrixX3d points(static_cast<Eigen::Index>(table.size()), 3);
  for (size_t i = 0; i < table.size(); ++i) {
    const Eigen::RowVector3d weights = table.barycentric[i].cast<double>().transpose();
    points.row(static_cast<Eigen::Index>(i)).setZero();
    for (int k = 0; k < 3; ++k) {
      points.row(static_cast<Eigen::Index>(i)) += weights[k] * rest_vertices.row(faces(table.face[i], k));
    }
  }
  return points;
}

TexelCounterparts FindTexelCounterparts(const RestViews& views, const MatrixX3d& points) {
  TexelCounterparts counterparts;
  for (auto& of_kind : counterparts) of_kind.resize(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector3d point = points.row(i).transpose(), mirrored(-point.x(), point.y(), point.z());
    const std::optional<RestSide> side = views.SideOf(point);
    if (!side) continue;
    const RestSide other = *side == RestSide::kFront ? RestSide::kBack : RestSide::kFront;
    counterparts[kMirror][i] = views.At(*side, mirrored);
    counterparts[kBehind][i] = views.At(other, point);
    counterparts[kAcross][i] = views.At(other, mirrored);
  }
  return counterparts;
}

}  // namespace bodyloom
