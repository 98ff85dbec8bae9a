// SPDX-License-Identifier: Apache-2.0
/// Projects Gaussians of the camera frame to the screen, and backpropagates derivatives.
///
/// The projection is linearised at each mean x (EWA splatting: Zwicker et al., "EWA Volume Splatting", Visualization
/// 2001; Kerbl et al., "3D Gaussian Splatting", SIGGRAPH 2023, eq. 5). With J = d pixel / d x:
///   mean = pixel of x,  B = J F,  Σ₂ = B Bᵀ + low_pass · I,  K = Σ₂⁻¹
/// Pixels of α ≥ 1/255 lie within sqrt(2 ln(255 o) Σ₂,xx) and sqrt(2 ln(255 o) Σ₂,yy) of the mean: the half extents,
/// with a margin for rounding. Gaussians that are not drawn: see ScreenGaussians (render/splat/camera_gaussians.h).
///
/// Derivatives are complete, including the dependence of J on x.
///
/// Same bytes for any number of threads and any instruction set.
#pragma once

#include <string>

#include "geometry/scene/camera.h"
#include "render/splat/camera_gaussians.h"

namespace bodyloom {

struct ProjectGaussiansOptions {
  float low_pass_px2 = 0.2F;  ///< 0 to 100: pixel filter, added to the covariance on the screen
  float near_m = 0.1F;        ///< pinhole: nothing nearer than this is drawn; at least Camera::kMinDepth
  int num_threads = 1;        ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Fills `screen`, one row per Gaussian in the same order. Throws std::invalid_argument when the options are not valid
/// or the camera has lens distortion (undistort the image first) or numbers that are not finite.
void ProjectGaussians(const CameraGaussians& gaussians, const Camera& camera, const ProjectGaussiansOptions& options,
                      ScreenGaussians* screen);

/// Computes d loss / d gaussians (columns of CameraGaussians) from d loss / d screen (rows as in `screen`,
/// ScreenGaussians::kNumGradients columns); zero for Gaussians that are not drawn. `screen` is the output of
/// ProjectGaussians for the same gaussians, camera and options. Throws as above, and for tables of other sizes.
void ProjectGaussiansBackward(const CameraGaussians& gaussians, const ScreenGaussians& screen,
                              const FloatColumns& by_screen, const Camera& camera,
                              const ProjectGaussiansOptions& options, FloatColumns* by_gaussians);

}  // namespace bodyloom
