// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/photo/guess_texture.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

void GuessTexture(const TexelNeighbours& neighbours, PartialTexture* texture) {
  BODYLOOM_CHECK(texture->size == neighbours.texture_size(), "texture guess: a texture of ", texture->size,
                 " texels a side, expected ", neighbours.texture_size());
  texture->guessed = neighbours.FillUnseen(texture->visible, 3, texture->colour);
}

}  // namespace bodyloom
