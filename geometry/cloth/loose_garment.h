// SPDX-License-Identifier: Apache-2.0
/// A loose garment (skirt, dress, coat) as cloth: rings of vertices around the body, of which the first is pinned to
/// it.
///
/// Each column is at an angle φ about the body's vertical (0 in front, increasing towards the body's left). At distance
/// s down from the pinned ring along the cloth it lies, as sewn, at
///   x(φ, s) = pinned(φ) + s (fullness · outwards(φ) − √(1 − fullness²) · up),
/// a cone around the body: fullness 0 hangs straight, 1 is a full circle. Distances on it are the rest lengths of the
/// links: along and across (unstretchable), diagonals (shear), and from each vertex to the second next (bending). A
/// slit leaves the tube open in front below a row. Tethers keep each vertex within its distance s of its pinned vertex.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/cloth/cloth_simulation.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// A vertex held at a point of the body's (clothed) surface, lift_m outside of it.
struct SurfacePin {
  int face = 0;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  double lift_m = 0;
};

struct LooseGarmentOptions {
  double waist_y_m = 0;      ///< height of the pinned ring, of the shaped body in T-pose
  double length_m = 0.6;     ///< along the cloth
  double fullness = 0.5;     ///< in [0, 0.95]
  double spacing_m = 0.025;  ///< approximate distance of the rings and, at the hem, of the columns
  int columns = 0;           ///< 16 or more; 0: by the spacing
  double slit_from_m = -1;   ///< open in front from this distance along the cloth on; negative: closed
  double lift_m = 0.012;
  double mass_kg_m2 = 0.25;
  double shear_compliance = 0.1, bend_compliance = 8;  ///< metres per newton
};

struct LooseGarment {
  ClothMesh cloth;                    ///< faces counter-clockwise seen from outside
  std::vector<Eigen::Vector3d> sewn;  ///< as sewn, around the body in T-pose
  std::vector<SurfacePin> pins;       ///< of the vertices of mass 0, by index
  /// As drawn: where the ring closes, vertices are doubled, so that `pattern` (circumference at mid-length, distance
  /// down, 0; metres) has no discontinuity inside a face.
  std::vector<int> drawn_from;  ///< D: vertex of the cloth
  MatrixX3i drawn_faces;        ///< same order as cloth.faces
  MatrixX3f pattern;            ///< D×3
  double around_m = 0;          ///< period of `pattern` around the ring, metres
  int rings = 0, columns = 0;
  [[nodiscard]] bool empty() const { return sewn.empty(); }
};

/// Cuts the garment for a shaped, clothed body in T-pose (vertices V×3, faces). Points further than arm_x_m from the
/// middle (the arms) are ignored. Throws std::invalid_argument when options are out of range or no body is found at the
/// pinned ring's height.
LooseGarment CutLooseGarment(const MatrixX3d& vertices, const MatrixX3i& faces, double arm_x_m,
                             const LooseGarmentOptions& options);

/// Moves all but the pinned vertices by noise of 2 mm: a perfectly regular cone would stay in equilibrium instead of
/// falling into folds.
void AddPositionNoise(LooseGarment* garment, uint64_t seed);

/// Positions of the pinned vertices on a body's posed, clothed surface.
std::vector<Eigen::Vector3d> PinnedPlaces(const std::vector<SurfacePin>& pins, const MatrixX3d& vertices,
                                          const MatrixX3i& faces);

}  // namespace bodyloom
