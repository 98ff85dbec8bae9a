// SPDX-License-Identifier: Apache-2.0
/// Architecture cards of the renderers: every network's parameters, shapes and multiply–adds, as text.
#pragma once

#include <string>

#include "neural/guided/guided_config.h"
#include "neural/motion/motion_config.h"
#include "neural/photo/photo_config.h"

namespace bodyloom {

/// Card of the pose-guided renderer with one section per network (neural/networks/architecture_card.h), for one frame
/// of the profile's whole window with the source already encoded: SilNet, GarNet, RenderNet, and the discriminator of
/// training; the cost of encoding the source is a separate line. Networks that are left out have no section.
std::string GuidedCard(const GuidedConfig& config);

/// Card of the motion-dependent renderer with one section per network, for one frame of the profile's whole image.
std::string MotionCard(const MotionConfig& config);

/// Card of the one-photo renderer with one section per network: FeatureNet for a photo's texture, RenderNet for one
/// frame of the profile's whole image, the discriminators for an image in training. Variants list only the networks
/// that they use.
std::string PhotoCard(const PhotoConfig& config);

}  // namespace bodyloom
