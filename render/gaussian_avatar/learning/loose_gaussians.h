// SPDX-License-Identifier: Apache-2.0
/// Initialises Gaussians off the skin, for clothes, hair and shoes: a grid inside the visual hull.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "render/gaussian_avatar/gaussian_body.h"
#include "render/gaussian_avatar/learning/training_view.h"

namespace bodyloom {

struct LooseGaussiansOptions {
  float spacing_m = 0.014F;  ///< 0.004 to 0.1: of the grid in rest space
  float reach_m = 0.35F;     ///< 0.02 to 1: from the skin
  /// A grid point is kept if the share of the views containing it that show the person there lies between these: it is
  /// air below, inside the body above.
  float min_share = 0.72F, max_share = 0.95F;
  int max_views = 120;       ///< at least 1, evenly spaced
  int count = 16000;         ///< at least 0: maximum number, a random subset
  float opacity_logit = -1;  ///< −20 to 20
  float albedo = 0.4F;       ///< 0 to 1
  float covered_from_m = 0,
        covered_to_m = 0;  ///< heights in rest space without loose Gaussians, for a garment
  uint64_t seed = 1;
  int num_threads = 1;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Creates isotropic Gaussians with σ half the spacing and the six largest weights of SmoothSkinWeights (the pelvis
/// always included), anchored at the nearest vertex with a corrective factor that decreases from 1 on the skin to 0 at
/// 6 cm, normals away from that vertex. The light stays zero: append the result to SkinGaussians(). Deterministic for a
/// given seed and any number of threads. Throws std::invalid_argument when options are not valid.
GaussianBody LooseGaussians(const BodyModel& model, const Eigen::VectorXd& betas, std::span<const TrainingView> views,
                            const LooseGaussiansOptions& options);

/// Adds the rows of `more`; the light stays.
void AppendGaussians(const GaussianBody& more, GaussianBody* body);

/// Distances to the body at rest and smooth skinning weights for points around it, for cloth and hair: the mean of the
/// vertices' weights, weighted by a Gaussian of the distance with σ = max(3 cm, 0.7 × distance to the body), so that
/// points between the legs follow both. Computed on a grid of spacing kCell and interpolated; points farther than
/// `reach` from the skin have no weights.
class SmoothSkinWeights {
 public:
  static constexpr float kCell = 0.04F;  ///< metres

  /// reach: metres. Throws std::invalid_argument unless it is within 0.01 to 2.
  SmoothSkinWeights(const BodyModel& model, const Eigen::VectorXd& betas, float reach, int num_threads);

  /// Distance to the nearest vertex, interpolated, metres; larger than the reach for points beyond it.
  [[nodiscard]] float DistanceTo(const Eigen::Vector3f& place) const;
  /// Computes J weights that sum to 1, of a point within the reach.
  void WeightsAt(const Eigen::Vector3f& place, float* weights) const;
  /// The vertex nearest to a point, exact.
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
  std::vector<float> distance_;  ///< by node; a lower bound beyond the reach
  std::vector<float> weights_;   ///< nodes × J
};

}  // namespace bodyloom
