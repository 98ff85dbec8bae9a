// SPDX-License-Identifier: Apache-2.0
/// Pixels in which an arm lies before the trunk or the thighs, though the fitted body has it a little beside them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodyloom/render/image.h"

namespace bodyloom {

/// `mask` (one a pixel, 0 where the person is not) without the pixels in which the body shows trunk or thighs, an arm or a
/// hand of the body is within `reach_px`, and the photo shows skin: its label is skin or face (`labels`, PersonLabel), or
/// its colour is nearer to the face's median colour than to that of the trunk, or of the thighs, away from the arms.
/// `parts`: DensePose's, of the body in the picture. Throws std::invalid_argument when sizes do not fit.
std::vector<uint8_t> WithoutLimbLeaks(const Image& picture, std::span<const uint8_t> mask,
                                      std::span<const uint8_t> labels, std::span<const uint8_t> parts, int reach_px);

}  // namespace bodyloom
