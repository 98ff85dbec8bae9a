// SPDX-License-Identifier: Apache-2.0
/// Crops windows to the part that the networks see: the body and the reach of clothes around it. A window is as large
/// as a clip's largest pose; most frames need half of it or less. Internal: includes LibTorch.
#pragma once

#include <span>
#include <vector>

#include "neural/motion/motion_frame.h"
#include "neural/motion/motion_model.h"
#include "render/image/pixel_box.h"

namespace bodyloom {

/// One box per frame, all of one size: each contains its frame's body grown by `reach` pixels (clipped to the window)
/// and is aligned to the networks' strides (neural/networks/aligned_box.h). reach 0: whole windows. Frames' sides are
/// multiples of `multiple`. Throws std::invalid_argument unless they are of one size and, with a reach, hold their body
/// masks.
std::vector<PixelBox> PersonBoxes(std::span<const MotionFrame> frames, int reach, int multiple);

/// Crops a frame's maps and images to the box; everything else stays (before_x and before_y are the window's). Throws
/// std::invalid_argument when an image is not of the frame's size.
MotionFrame Within(MotionFrame frame, const PixelBox& box);

/// Crops 1×… to the box; a view.
torch::Tensor Within(const torch::Tensor& map, const PixelBox& box);
MotionState Within(const MotionState& state, const PixelBox& box);

/// Pastes `inside` (1×…) into a window of height × width at the box, with zeros around it, class 0 for labels.
torch::Tensor OnWindow(const torch::Tensor& inside, const PixelBox& box, int64_t height, int64_t width);
MotionState OnWindow(const MotionState& inside, const PixelBox& box, int64_t height, int64_t width);

}  // namespace bodyloom
