// SPDX-License-Identifier: Apache-2.0
/// A person in other light, from surface normals: the ratio image.
///   relit = light · clamp( max(S_new(n), ε) / max(S_old(n), ε) ),     S: shading (render/lighting/sh_lighting.h)
/// colour by colour, on light and not on encoded values. Exact for Lambertian surfaces without cast shadows; texture
/// needs no model, since albedo cancels out. Shadows and highlights that the picture has stay in it.
#pragma once

#include <span>

#include "bodyloom/render/lighting/sh_lighting.h"

namespace bodyloom {

struct RelightOptions {
  PixelEncoding encoding = PixelEncoding::kSrgb;
  double min_shading = 0.05;       ///< ε
  double max_ratio = 4;            ///< brightening beyond this would show the noise of dark pixels
  double min_normal_length = 0.3;  ///< normals shorter than this, over alpha, are not known: the pixel stays
};

/// `image` (3 planes RGB in [0, 1], multiplied by alpha) of `alpha.size()` pixels with `normals` (3 planes, camera
/// frame, shortened by alpha) is relit in place. Pixels with alpha below 1/255 stay. Throws std::invalid_argument when
/// sizes do not fit or an option is not positive.
void Relight(const ShLighting& old_light, const ShLighting& new_light, std::span<const float> normals,
             std::span<const float> alpha, const RelightOptions& options, std::span<float> image);

}  // namespace bodyloom
