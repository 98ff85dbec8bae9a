// SPDX-License-Identifier: Apache-2.0
/// Nodes on a garment that move nearby points, as bones move skin (embedded deformation; Sumner, Schmid and Pauly,
/// "Embedded deformation for shape manipulation", SIGGRAPH 2007).
///
/// A node is a vertex of the garment as sewn that is at least spacing_m away from every node before it. A point x of
/// the garment's sewn configuration moves with node k as
///   x ↦ R_k (x − j_k) + p_k,
/// j_k and p_k the node's position as sewn and now, R_k the least-squares rotation (geometry/math/procrustes.h) of the
/// vertices within kReach·spacing_m of it as sewn to their current positions. Folds narrower than the distance of two
/// nodes are lost.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Rotations and positions of the nodes at one instant.
struct MovedNodes {
  std::vector<Eigen::Matrix3d> rotations;  ///< R_k
  MatrixX3d places;                        ///< K×3: p_k
};

/// Nodes that move a point, with positive weights that sum to 1; node 0 with weight 0 where the garment has fewer
/// nodes.
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

  /// `cloth`: current positions of the garment's vertices (from ClothRun). Where the vertices around a node are
  /// collinear, its rotation is that of the node before it (identity for the first). Throws std::invalid_argument for
  /// another number of vertices.
  [[nodiscard]] MovedNodes Move(std::span<const Eigen::Vector3d> cloth) const;

  /// The nodes nearest to a point of the sewn configuration, nearest first, weights proportional to exp(−d²/2σ²), σ =
  /// 0.6 spacing_m, d the distance as sewn.
  [[nodiscard]] NearestNodes Near(const Eigen::Vector3d& point) const;

 private:
  double spacing_m_;
  size_t num_vertices_;
  MatrixX3d places_;
  std::vector<int> vertices_;              ///< K: the nodes among the garment's vertices
  std::vector<std::vector<int>> around_;   ///< K: vertices around a node
  std::vector<MatrixX3d> around_as_sewn_;  ///< K: their positions as sewn
};

}  // namespace bodyloom
