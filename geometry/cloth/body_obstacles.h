// SPDX-License-Identifier: Apache-2.0
/// Obstacles that a posed, clothed body presents to cloth: the surface points of trunk and legs, and one capsule per
/// bone that lies inside it (trunk and legs) or fills it (arms, hands). Legs and hips belong inside a loose garment,
/// arms outside.
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_simulation.h"

namespace bodyloom {

/// True if the SMPL joint moves trunk or legs, the parts that carry a loose garment and are hidden by it.
inline bool IsOfTrunkOrLegs(int joint) { return joint <= 11; }

/// Immutable, may be shared by threads.
class BodyObstacles {
 public:
  /// Takes the shaped, clothed body in T-pose: V×3 vertices and J×3 joints. The radius of a bone's capsule at each end
  /// derives from the distances of the bone's vertices from its axis: 0.8 times their first decile for the trunk, 0.85
  /// times their mean for legs, their mean for arms.
  BodyObstacles(const BodyModel& body, const MatrixX3d& vertices, const MatrixX3d& joints);

  /// Obstacles at a pose, given by vertices (V×3), normals (V×3) and joints (J×3) in one frame.
  [[nodiscard]] ClothObstacles At(const MatrixX3d& vertices, const MatrixX3f& normals, const MatrixX3d& joints) const;

  /// Faces between the surface's points, for ClothSimulation.
  [[nodiscard]] const MatrixX3i& surface_faces() const { return faces_; }
  /// Body vertex of each surface point.
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
