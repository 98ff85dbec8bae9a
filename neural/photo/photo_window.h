// SPDX-License-Identifier: Apache-2.0
/// The window of an image that RenderNet sees, in training and inference: a rectangle around the body.
///
/// Pixels farther from the body than clothes in training are background by definition and need not be computed.
/// Training and rendering must use the same rule for the rectangle, because instance normalisation makes every pixel
/// depend on the whole input.
#pragma once

#include <span>
#include <vector>

#include "render/texture/photo_frame.h"

namespace bodyloom {

struct PhotoWindow {
  int x = 0, y = 0, width = 0, height = 0;
};

inline constexpr int kPhotoWindowMultiple = 32;

/// The box of the pixels with a part other than 0, grown by `reach` pixels on every side; sides at least
/// `smallest_side` and rounded up to multiples of 32 (few sizes, so that plans of convolutions are reused), but clipped
/// to the frame. A frame without a body gives the minimum window at the centre.
PhotoWindow WindowAround(const PhotoFrame& frame, int reach, int smallest_side);

/// The windows grown to the sides of the largest, for a batch; `size` is the frames' side.
std::vector<PhotoWindow> EqualWindows(std::span<const PhotoWindow> windows, int size);

/// Reach of clothes and hair beyond the body, pixels (neural/motion/motion_frame.h), over a sample of frames spread
/// evenly over persons and their frames; 0 when they have no labels.
int PhotoReach(const PhotoSource& source, std::span<const int> persons, int num_frames = 64);

/// Box of the head's parts (DensePose 23 and 24) in the frame; width 0 if it is not visible, or if its face is turned
/// away: fewer than two thirds of its pixels show texels of its front. For the built-in body's head seen at 0, 45, 60
/// and 90 degrees from the front the share is 0.89, 0.74, 0.66 and 0.48. `back_of_head`: U × U
/// (render/texture/complete/body_part_map.h). Throws std::invalid_argument for sizes that do not fit.
PhotoWindow FaceBox(const PhotoFrame& frame, std::span<const uint8_t> back_of_head);

}  // namespace bodyloom
