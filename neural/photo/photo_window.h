// SPDX-License-Identifier: Apache-2.0
/// The part of a picture that RenderNet sees, in training and at work: a rectangle around the body.
///
/// What lies farther from the body than clothes ever did in training is background by definition, so pixels outside
/// the rectangle need not be computed. The rectangle cannot be left to chance: instance normalisation makes every
/// pixel depend on all that the network sees, so that training must see the rectangles that rendering will use.
#pragma once

#include <span>
#include <vector>

#include "render/texture/photo_frame.h"

namespace bodyloom {

struct PhotoWindow {
  int x = 0, y = 0, width = 0, height = 0;
};

inline constexpr int kPhotoWindowMultiple = 32;

/// Around the pixels with a part other than 0, `reach` pixels more on every side; sides at least `smallest_side` and
/// rounded up to multiples of 32 (few sizes, so that convolutions are planned once each) but never beyond the frame.
/// A frame without a body gives the smallest window in the middle.
PhotoWindow WindowAround(const PhotoFrame& frame, int reach, int smallest_side);

/// The same windows grown to the sides of the largest, for a batch; `size` is the frames' side.
std::vector<PhotoWindow> EqualWindows(std::span<const PhotoWindow> windows, int size);

/// How far clothes and hair reach beyond the body, pixels (neural/motion/motion_frame.h), over some frames of the
/// persons; 0 when they have no labels. Frames are spread over persons and frames alike.
int PhotoReach(const PhotoSource& source, std::span<const int> persons, int num_frames = 64);

/// Box of the head's parts (DensePose 23 and 24) in the frame; width 0 where it is not to be seen, or where its face
/// does not look at the camera: less than two thirds of its pixels show texels of its front. Of the built-in body's
/// head seen from 0, 45, 60 and 90 degrees past the face they are 0.89, 0.74, 0.66 and 0.48. `back_of_head`: U × U
/// (render/texture/complete/body_part_map.h). Throws std::invalid_argument for sizes that do not fit.
PhotoWindow FaceBox(const PhotoFrame& frame, std::span<const uint8_t> back_of_head);

}  // namespace bodyloom
