// SPDX-License-Identifier: Apache-2.0
/// A posed, clothed body as what cloth collides with: the surface of trunk and legs point by point, and a capsule a
/// bone that lies inside it (trunk and legs) or fills it (arms, hands). Legs and hips belong inside a loose
/// garment, arms outside.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_simulation.h"

namespace bodyloom {

/// Whether one of SMPL's joints moves trunk or legs, which a loose garment hangs on and hides.
inline bool IsOfTrunkOrLegs(int joint) { return joint <= 11; }

/// Immutable, may be shared by threads.
class BodyObstacles {
 public:
  /// From the shaped, clothed body in T-pose: V×3 vertices and J×3 joints. A bone's capsule has, at each end, a share
  /// of the mean distance of the bone's vertices from its axis: 0.8 of the least tenth for the trunk, 0.85 of the mean
  /// for legs, all of it for arms.
  BodyObstacles(const BodyModel& body, const MatrixX3d& vertices, const MatrixX3d& joints);

  /// At a pose: vertices V×3, normals V×3 and joints J×3 in one frame.
  [[nodiscard]] ClothObstacles At(const MatrixX3d& vertices, const MatrixX3f& normals, const MatrixX3d& joints) const;

  /// Faces between the surface's points, for ClothSimulation.
  [[nodiscard]] const MatrixX3i& surface_faces() const { return faces_; }
  /// Vertices of the body that the surface's points are.
  [[nodiscard]] const std::vector<int>& surface_vertices() const { return vertices_; }

 private:
  struct Bone {
    int from, to;
    double radius_from, radius_to;
    bool yields;
    ClothSide belongs;
  };
  std::vector<int> vertices_;
  std::vector<ClothSide> belongs_;  ///< of the vertices
  MatrixX3i faces_;
  std::vector<Bone> bones_;
};

}  // namespace bodyloom
