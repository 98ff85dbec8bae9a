// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/photo/guess_texture.h"

#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/people/guess_unseen.h"

namespace bodyloom {

void GuessTexture(const TexelNeighbours& neighbours, PartialTexture* texture) {
  BODYLOOM_CHECK(texture->size == neighbours.texture_size(), "texture guess: a texture of ", texture->size,
                 " texels a side, expected ", neighbours.texture_size());
  std::vector<uint8_t> labels = texture->labels;
  CallFacesBehindHair(neighbours.back_of_head(), labels);
  texture->guessed = GuessUnseen(neighbours, labels, texture->colour);
}

}  // namespace bodyloom
