// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/cloth/cloth_faults.h"

#include <algorithm>

namespace bodyloom {

using Eigen::Vector3d;

int LegsThroughCloth(const MatrixX3i& faces, const std::vector<Vector3d>& cloth, const MatrixX3d& joints) {
  int through = 0;
  for (const int hip : {1, 2}) {
    int crossings = 0;
    for (const int from : {hip, hip + 3}) {
      crossings += CrossingsOfSegment(faces, cloth, joints.row(from).transpose(), joints.row(from + 3).transpose());
    }
    through += crossings % 2;
  }
  return through;
}

double LargestDepth(const std::vector<Vector3d>& cloth, const ClothObstacles& obstacles) {
  constexpr double kReach_m = 0.06;
  double deepest = 0;
  for (const Vector3d& p : cloth) {
    Eigen::Index nearest;
    const double distance2 = (obstacles.points.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    if (distance2 > kReach_m * kReach_m) continue;
    const Vector3d d = p - obstacles.points.row(nearest).transpose();
    deepest = std::max(deepest, -obstacles.normals.row(nearest).cast<double>().dot(d));
  }
  return deepest;
}

}  // namespace bodyloom
