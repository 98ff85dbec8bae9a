// SPDX-License-Identifier: Apache-2.0
/// Estimates the light on a person from an image: nine spherical-harmonic coefficients of the shading
/// (render/lighting/sh_lighting.h), jointly with one albedo per label, so that dark trousers are not taken for shadow.
///
///   minimises ½ Σ_i ρ( (a_l(i) · c·Y(n_i) − y_i)² / σ² ) + ½ (w Σ_i (a_l(i) − 1)/N)² + ½ N (r/σ)² Σ_k>0 c_k²
/// over c in R⁹ and the albedos a_l. The last term only fixes directions that the normals do not constrain (seen from
/// one side, 1, z and z² are nearly collinear).
///
/// y_i: light of a pixel (luminance, or one colour), n_i its normal, l(i) its label. Albedo and light are determined
/// only up to a common factor: the mean albedo over the samples is 1, so the shading is in units of it. ρ is Tukey's
/// biweight at 4.685 σ, σ from the residuals' median, at least r times the light's median; it rejects cast shadows,
/// prints and highlights. Initialised by least squares of y/median_l(y), then Huber. The shading is not constrained to
/// be positive; the summary reports how often it is negative. Solver: Ceres, analytic derivatives. One thread, so that
/// the result is deterministic.
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
  double ridge = 1e-3;       ///< r above: weight of the prior towards even light
  double min_spread = 1e-9;  ///< smallest over largest eigenvalue of Σ Y Yᵀ over the normals
};

enum class FitLightingStatus {
  kConverged,
  kNotConverged,     ///< out of iterations; the coefficients are usable
  kTooFewSamples,    ///< fewer than 50
  kNormalsTooAlike,  ///< the normals do not determine nine coefficients
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
  std::vector<double> albedo;                ///< by label 0 … largest; mean over the samples 1; 0 for unused labels
  FitLightingSummary summary;
};

/// `normals` N×3 (any length but 0), `light` N values (not encoded ones: DecodePixel), `labels` N values or none (one
/// albedo). Throws std::invalid_argument when sizes differ. Fits one colour per call; luminance gives one light for all
/// three.
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
