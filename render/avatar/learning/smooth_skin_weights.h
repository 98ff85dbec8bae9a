// SPDX-License-Identifier: Apache-2.0
/// Skin weights of places off the body: what cloth and hair hang on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {

/// The body's shape at rest, and for places around it the distance to the nearest vertex and smooth weights: the mean of
/// the vertices' weights, weighted by a Gaussian of the distance with σ = max(3 cm, 0.7 × distance to the body), so that
/// what hangs between the legs goes with both. Worked out on a grid of kCell and interpolated; places beyond `reach` from
/// the skin are farther than that and have no weights.
class SmoothSkinWeights {
 public:
  static constexpr float kCell = 0.04F;  ///< metres

  /// reach: metres. Throws std::invalid_argument unless it is within 0.01 to 2.
  SmoothSkinWeights(const BodyModel& model, const Eigen::VectorXd& betas, float reach, int num_threads);

  /// Metres to the nearest vertex, interpolated; more than the reach where the place is beyond it.
  [[nodiscard]] float DistanceTo(const Eigen::Vector3f& place) const;
  /// J weights that sum to 1, of a place within the reach.
  void WeightsAt(const Eigen::Vector3f& place, float* weights) const;
  /// Exactly, not interpolated.
  [[nodiscard]] int NearestVertex(const Eigen::Vector3f& place) const;

  [[nodiscard]] const MatrixX3f& vertices() const { return vertices_; }
  [[nodiscard]] const Eigen::Vector3f& low() const { return low_; }  ///< corner of the grid
  [[nodiscard]] Eigen::Vector3f high() const;                        ///< the opposite one
  [[nodiscard]] int num_joints() const { return num_joints_; }

 private:
  struct Corner {
    size_t index;
    float share;
  };
  void CornersAt(const Eigen::Vector3f& place, Corner* corners) const;
  void FillNode(const BodyModel& model, size_t node);

  MatrixX3f vertices_;
  std::vector<float> columns_[3];  ///< of vertices_
  Eigen::Vector3f low_;
  Eigen::Vector3i size_;
  float reach_;
  int num_joints_;
  std::vector<float> distance_;  ///< by node; beyond the reach no more than a lower bound
  std::vector<float> weights_;   ///< nodes × J
};

}  // namespace bodyloom
