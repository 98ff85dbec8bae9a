// SPDX-License-Identifier: Apache-2.0
/// The reach of clothes and hair beyond the body, so that a renderer need not look for the person elsewhere.
#pragma once

#include <span>

#include "bodyloom/neural/motion/motion_frame.h"

namespace bodyloom {

/// The smallest number of pixels r such that squares of side 2r + 1 around the body's pixels hold all but `left_out` of
/// the foreground (labels other than 0) of the frames; 0 when the frames have no labels or no foreground. Frames
/// without a body are passed over.
int ClothesReach(std::span<const MotionFrame> frames, double left_out = 0.001);

}  // namespace bodyloom
