// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/network_card.h"

#include "bodyloom/neural/guided/guided_card.h"
#include "bodyloom/neural/motion/motion_card.h"
#include "bodyloom/neural/photo/photo_card.h"

namespace bodyloom {

std::string NetworkCard(NeuralRenderer renderer, const std::string& profile) {
  if (renderer == NeuralRenderer::kPhoto) return PhotoCard({PhotoProfileNamed(profile)});
  if (renderer == NeuralRenderer::kGuided) return GuidedCard({GuidedProfileNamed(profile)});
  MotionConfig config;
  config.profile = MotionProfileNamed(profile);
  return MotionCard(config);
}

}  // namespace bodyloom
