// SPDX-License-Identifier: Apache-2.0
/// A rendered person laid into a picture.
#pragma once

#include <span>

#include "bodyloom/geometry/camera.h"
#include "bodyloom/render/image.h"
#include "bodyloom/render/person_window.h"

namespace bodyloom {

struct PictureSize {
  int width = 0, height = 0;
};
/// Of the pictures that are written: the window's shrunk picture, or, with `full_size`, the camera's.
PictureSize SizeOfPictures(const PersonWindow& window, const Camera& camera, bool full_size);

/// Lays the picture of frame t's window into a picture of the window's shrunk size or a larger one of its shape: there
/// image + (1 − alpha) · picture, image and alpha interpolated between the four nearest pixels (0 outside the window),
/// so exact where nothing is enlarged. `image` is planar RGB in [0, 1] already multiplied by alpha, as the renderers
/// give it, of window.width × window.height pixels.
void Composite(std::span<const float> image, std::span<const float> alpha, const PersonWindow& window, int t,
               Image* picture);

}  // namespace bodyloom
