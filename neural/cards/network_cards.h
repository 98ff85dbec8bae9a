// SPDX-License-Identifier: Apache-2.0
/// The architecture card of the pose-guided renderer: every network's parameters, shapes and multiply–adds, as text.
#pragma once

#include <string>

#include "neural/guided/guided_config.h"
#include "neural/motion/motion_config.h"
#include "neural/photo/photo_config.h"

namespace bodyloom {

/// A section a network (neural/networks/architecture_card.h), of one frame of the profile's whole window once the
/// source is encoded: SilNet, GarNet, RenderNet, and the discriminator of training; what encoding the source costs is a
/// line of its own. Networks that are left out have no section.
std::string GuidedCard(const GuidedConfig& config);

// The architecture card of the motion-dependent renderer: every network's parameters, shapes and multiply–adds, as
// text.

/// A section a network (neural/networks/architecture_card.h), of one frame of the profile's whole image.
std::string MotionCard(const MotionConfig& config);

// The architecture card of the one-photo renderer: every network's parameters, shapes and multiply–adds, as text.

/// A section a network (neural/networks/architecture_card.h): FeatureNet of a photo's texture, RenderNet of one frame
/// of the profile's whole image, the discriminators of a picture in training. A variant has those that it is made of.
std::string PhotoCard(const PhotoConfig& config);

}  // namespace bodyloom
