// SPDX-License-Identifier: Apache-2.0
/// A picture of a motion library: stick figures of SMPL's 24 joints at several instants of every clip.
///
/// A clip is a strip with its label: the upper row shows the person's front, the lower row the left side (by the
/// pelvis' heading at that instant; an upright person walks to the left in the lower row). The left limbs are warm, the
/// right ones cool (render/image/palette.h), so warm colours are on the right in the upper row unless a clip is
/// mirrored. The line is y = 0, drawn if the clip has a flat floor; figures keep their height above it.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/track.h"
#include "render/image/image.h"

namespace bodyloom {

struct MotionSheetOptions {
  int instants = 10;         ///< spread evenly over the clip, first and last included
  int figure_width_px = 76;  ///< of an instant
  int columns = 2;           ///< strips side by side
};

/// Draws one clip's strip. Clips that reach higher than 2.2 m are drawn smaller. The motion must have 24 joints and y
/// up; throws std::invalid_argument otherwise.
Image DrawMotionStrip(const Motion& motion, bool has_floor, const std::string& label,
                      const MotionSheetOptions& options = {});

/// Arranges strips of equal size below one another, column by column. Throws std::invalid_argument when there are none.
Image MotionSheet(const std::vector<Image>& strips, const MotionSheetOptions& options = {});

}  // namespace bodyloom
