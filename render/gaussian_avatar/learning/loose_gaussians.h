// SPDX-License-Identifier: Apache-2.0
/// Gaussians off the skin to begin with, where clothes, hair and shoes may be: a grid inside the visual hull.
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
  /// A place is kept when at least / at most this share of the views that it lies in shows the person there: below it
  /// is air, above it is inside the body.
  float least_share = 0.72F, most_share = 0.95F;
  int most_views = 120;      ///< 1 or more, spread evenly
  int count = 16000;         ///< 0 or more: at most so many, drawn at random
  float opacity_logit = -1;  ///< −20 to 20
  float albedo = 0.4F;       ///< 0 to 1
  float covered_from_m = 0,
        covered_to_m = 0;  ///< heights in rest space between which none are put: a garment has its own
  uint64_t seed = 1;
  int num_threads = 1;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Round Gaussians of σ half the spacing with the six largest of the smooth skin weights
/// (render/gaussian_avatar/learning/loose_gaussians.h; the pelvis always among them), anchored at the nearest vertex
/// with a corrective factor that falls from 1 on the skin to 0 at 6 cm, normals away from that vertex. The light stays
/// zero: the answer is to be appended to SkinGaussians(). A function of the seed alone, whatever the number of threads.
/// Throws std::invalid_argument when options are not valid.
GaussianBody LooseGaussians(const BodyModel& model, const Eigen::VectorXd& betas, std::span<const TrainingView> views,
                            const LooseGaussiansOptions& options);

/// Adds the rows of `more`; the light stays.
void AppendGaussians(const GaussianBody& more, GaussianBody* body);

// Skin weights of places off the body: what cloth and hair hang on.

/// The body's shape at rest, and for places around it the distance to the nearest vertex and smooth weights: the mean
/// of the vertices' weights, weighted by a Gaussian of the distance with σ = max(3 cm, 0.7 × distance to the body), so
/// that what hangs between the legs goes with both. Worked out on a grid of kCell and interpolated; places beyond
/// `reach` from the skin are farther than that and have no weights.
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
