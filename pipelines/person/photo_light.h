// SPDX-License-Identifier: Apache-2.0
/// The light in a photo of a person, from the photo itself (render/lighting/fit_lighting.h).
#pragma once

#include <cstdint>
#include <span>

#include "bodyloom/render/image.h"
#include "bodyloom/render/lighting/fit_lighting.h"
#include "bodyloom/render/lighting/lit_surface.h"
#include "bodyloom/render/lighting/sh_lighting.h"

namespace bodyloom {

/// One view shows half of all normals, among which 1, z and z² are much alike: what they leave open is even light.
inline constexpr double kPhotoRidge = 0.1;
struct PhotoLight {
  /// Camera frame, one for all colours; its shading has the mean 1 over the person's pixels. Even light where it was not
  /// found.
  ShVector coefficients = EvenLight();
  FitLightingSummary fit;  ///< IsUsable(): it was found
};

/// The light on the person of `picture`, whose dressed body `surface` looks at. `labels`: PersonLabel, one a pixel of the
/// picture, each of which has an albedo of its own; the person is where they are not 0. Throws std::invalid_argument when
/// sizes differ.
PhotoLight LightOfPhoto(const Image& picture, std::span<const uint8_t> labels, const LitSurface& surface);

}  // namespace bodyloom
