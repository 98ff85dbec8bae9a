// SPDX-License-Identifier: Apache-2.0
/// Writes Gaussians as a .ply file for 3D Gaussian Splatting viewers.
///
/// Binary, little endian, one element `vertex` of float32: x y z (metres, in the Gaussians' frame), nx ny nz (zeros),
/// f_dc_0 f_dc_1 f_dc_2 = (colour − 0.5)/0.28209479, opacity = ln(o/(1 − o)), scale_0..2 = ln of standard deviations in
/// metres, largest first, rot_0..3 = w x y z of the rotation to their axes. Source: Kerbl et al., "3D Gaussian
/// Splatting", SIGGRAPH 2023, scene/gaussian_model.py of its code.
#pragma once

#include <string>

#include "render/splat/camera_gaussians.h"

namespace bodyloom {

/// The file's bytes. Rows with non-finite numbers are left out. Opacities are clamped to [1e-6, 1 − 1e-6], standard
/// deviations to at least 1e-7 m.
std::string GaussianPlyBytes(const CameraGaussians& gaussians);

/// Written atomically. Throws std::runtime_error naming the path.
void WriteGaussianPly(const std::string& path, const CameraGaussians& gaussians);

}  // namespace bodyloom
