// SPDX-License-Identifier: Apache-2.0
/// Nodes on a garment that carry what lies near it as bones carry skin (embedded deformation; Sumner, Schmid and Pauly,
/// "Embedded deformation for shape manipulation", SIGGRAPH 2007).
///
/// A node is a vertex of the garment as sewn that is at least spacing_m away from every node before it. A point x of
/// the space in which the garment was sewn moves with node k as
///   x ↦ R_k (x − j_k) + p_k,
/// j_k and p_k the node's place as sewn and now, R_k the rotation that takes the vertices around it, those within
/// kReach·spacing_m as sewn, onto where they are now in the least-squares sense (geometry/math/procrustes.h). Folds
/// narrower than two nodes are apart are lost.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Where the nodes are at one instant.
struct MovedNodes {
  std::vector<Eigen::Matrix3d> rotations;  ///< R_k
  MatrixX3d places;                        ///< K×3: p_k
};

/// What a point hangs on: weights are positive and sum to 1; node 0 with weight 0 where the garment has fewer.
struct NearestNodes {
  static constexpr int kCount = 6;
  std::array<int, kCount> node{};
  std::array<double, kCount> weight{};
};

/// Immutable, may be shared by threads.
class ClothNodes {
 public:
  static constexpr double kReach = 1.5;

  /// Throws std::invalid_argument for an empty garment or a spacing that is not in (0, 1] metres.
  ClothNodes(const LooseGarment& garment, double spacing_m);

  [[nodiscard]] int size() const { return static_cast<int>(places_.rows()); }
  [[nodiscard]] const MatrixX3d& places() const { return places_; }  ///< K×3, as sewn: j_k

  /// `cloth`: places of the garment's vertices now, as ClothRun gives them. Where the vertices around a node have
  /// collapsed onto a line its rotation is that of the node before it (the first: none). Throws std::invalid_argument
  /// for another number of vertices.
  [[nodiscard]] MovedNodes Move(std::span<const Eigen::Vector3d> cloth) const;

  /// The nodes nearest to a point of the sewn garment's space, nearest first, weighted by exp(−d²/2σ²), σ = 0.6
  /// spacing_m, d counted from the nearest.
  [[nodiscard]] NearestNodes Near(const Eigen::Vector3d& point) const;

 private:
  double spacing_m_;
  size_t num_vertices_;
  MatrixX3d places_;
  std::vector<int> vertices_;              ///< K: the nodes among the garment's vertices
  std::vector<std::vector<int>> around_;   ///< K: vertices around a node
  std::vector<MatrixX3d> around_as_sewn_;  ///< K: their places as sewn
};

}  // namespace bodyloom
