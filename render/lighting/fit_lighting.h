// SPDX-License-Identifier: Apache-2.0
/// The light on a person from what its pixels show: nine spherical-harmonic coefficients of the shading
/// (render/lighting/sh_lighting.h), with an albedo for each label as unknowns of the same problem, so that dark
/// trousers are not taken for shadow.
///
///   minimises ½ Σ_i ρ( (a_l(i) · c·Y(n_i) − y_i)² / σ² ) + ½ (w Σ_i (a_l(i) − 1)/N)² + ½ N (r/σ)² Σ_k>0 c_k²
/// over c in R⁹ and the albedos a_l. The last term only decides what the normals leave open (seen from one side, 1, z
/// and z² are much alike).
///
/// y_i: light of a pixel (luminance, or one colour), n_i its normal, l(i) its label. Albedo and light have one common
/// factor that no picture determines: the mean albedo over the samples is 1, so the shading is in units of it. ρ is
/// Tukey's biweight at 4.685 σ, σ from the residuals' median, at least r times the light's median; it forgets cast
/// shadows, prints and highlights. Started from least squares of y/median_l(y), then Huber. The shading is not kept
/// from being negative; the result tells how often it is. Solver: Ceres, analytic derivatives. The same result for any
/// machine load: one thread.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "render/lighting/sh_lighting.h"

namespace bodyloom {

struct FitLightingOptions {
  int max_samples = 20000;  ///< evenly spread over those given
  int max_iterations = 50;
  double ridge = 1e-3;       ///< r above: how firmly what the normals hardly tell is held at even light
  double min_spread = 1e-9;  ///< of the normals: smallest over largest eigenvalue of Σ Y Yᵀ
};

enum class FitLightingStatus {
  kConverged,
  kNotConverged,     ///< out of iterations; the coefficients are usable
  kTooFewSamples,    ///< fewer than 50
  kNormalsTooAlike,  ///< the normals do not span what nine coefficients need
  kDark,             ///< no light: the median is not positive
};
std::string ToString(FitLightingStatus status);

struct FitLightingSummary {
  FitLightingStatus status = FitLightingStatus::kTooFewSamples;
  int samples = 0, left_out = 0;  ///< used; not finite or of length 0
  int iterations = 0;
  double spread = 0;          ///< see min_spread
  double sigma = 0;           ///< of the residuals, in units of y
  double outlier_share = 0;   ///< samples beyond 4.685 σ
  double negative_share = 0;  ///< samples whose shading came out negative
  double min_shading = 0;     ///< over the samples
  double mean_shading = 0;    ///< over the samples
  [[nodiscard]] bool IsUsable() const {
    return status == FitLightingStatus::kConverged || status == FitLightingStatus::kNotConverged;
  }
};

struct FitLightingResult {
  ShVector coefficients = ShVector::Zero();  ///< shading = coefficients · ShBasis(n); zero when not usable
  std::vector<double> albedo;                ///< by label 0 … largest; mean over the samples 1; 0 where nobody has it
  FitLightingSummary summary;
};

/// `normals` N×3 (any length but 0), `light` N values (not encoded ones: DecodePixel), `labels` N values or none (one
/// albedo). Throws std::invalid_argument when sizes differ. One colour a call; luminance serves all three.
FitLightingResult FitLighting(const MatrixX3d& normals, std::span<const double> light,
                              std::span<const uint8_t> labels = {}, const FitLightingOptions& options = {});

/// (a · c·Y − y) / σ; blocks: coefficients (9), albedo (1).
class ShadedAlbedoCost : public ceres::SizedCostFunction<1, 9, 1> {
 public:
  ShadedAlbedoCost(const ShVector& basis, double light, double sigma) : basis_(basis), light_(light), sigma_(sigma) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  ShVector basis_;
  double light_, sigma_;
};

}  // namespace bodyloom
