// SPDX-License-Identifier: Apache-2.0
/// The part of a window that the networks look at: where the body is, and around it as far as clothes reach. A window
/// is as large as a clip's largest pose; most frames need half of it and less. Internal: includes LibTorch.
#pragma once

#include <span>
#include <vector>

#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"
#include "render/image/pixel_box.h"

namespace bodyloom {

/// A box a frame, all of one size: each holds its frame's body and `reach` pixels around it (what the window has of
/// them) and lies among the networks' strides as the window does (neural/networks/aligned_box.h). reach 0: whole
/// windows. Frames' sides are multiples of `multiple`. Throws std::invalid_argument unless they are of one size and,
/// with a reach, hold their body masks.
std::vector<PixelBox> PersonBoxes(std::span<const MotionFrame> frames, int reach, int multiple);

/// The box's pixels of a frame's maps and pictures; everything else as it is (before_x and before_y are the window's).
/// Throws std::invalid_argument when a picture is not of the frame's size.
MotionFrame Within(MotionFrame frame, const PixelBox& box);

/// The box's pixels of 1×…; a view.
torch::Tensor Within(const torch::Tensor& map, const PixelBox& box);
MotionState Within(const MotionState& state, const PixelBox& box);

/// A window of height × width with `inside` (1×…) in the box and zeros around it, class 0 for labels.
torch::Tensor OnWindow(const torch::Tensor& inside, const PixelBox& box, int64_t height, int64_t width);
MotionState OnWindow(const MotionState& inside, const PixelBox& box, int64_t height, int64_t width);

}  // namespace bodyloom
