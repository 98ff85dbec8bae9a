// SPDX-License-Identifier: Apache-2.0
/// Gaussians off the skin to begin with, where clothes, hair and shoes may be: a grid inside the visual hull.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/render/avatar/gaussian_body.h"
#include "bodyloom/render/avatar/learning/training_view.h"

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
/// (render/avatar/learning/smooth_skin_weights.h; the pelvis always among them), anchored at the nearest vertex with a
/// corrective factor that falls from 1 on the skin to 0 at 6 cm, normals away from that vertex. The light stays zero: the
/// answer is to be appended to SkinGaussians(). A function of the seed alone, whatever the number of threads. Throws
/// std::invalid_argument when options are not valid.
GaussianBody LooseGaussians(const BodyModel& model, const Eigen::VectorXd& betas, std::span<const TrainingView> views,
                            const LooseGaussiansOptions& options);

/// Adds the rows of `more`; the light stays.
void AppendGaussians(const GaussianBody& more, GaussianBody* body);

}  // namespace bodyloom
