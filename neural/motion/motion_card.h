// SPDX-License-Identifier: Apache-2.0
/// The architecture card of the motion-dependent renderer: every network's parameters, shapes and multiply–adds, as
/// text.
#pragma once

#include <string>

#include "bodyloom/neural/motion/motion_config.h"

namespace bodyloom {

/// A section a network (neural/networks/architecture_card.h), of one frame of the profile's whole image.
std::string MotionCard(const MotionConfig& config);

}  // namespace bodyloom
