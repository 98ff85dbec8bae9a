// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/guess_maps.h"

#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/people/guess_unseen.h"

namespace bodyloom {

int GuessRest(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps) {
  BODYLOOM_CHECK(from > 0 && neighbours.texture_size() == maps->size, "coherent maps: neighbours of ",
                 neighbours.texture_size(), " texels a side for maps of ", maps->size);
  const std::vector<uint8_t> guessed = GuessUnseen(neighbours, maps->labels, maps->appearance);
  int count = 0;
  for (size_t i = 0; i < guessed.size(); ++i) {
    if (guessed[i] == 0) continue;
    maps->from[i] = from;
    ++count;
  }
  return count;
}

}  // namespace bodyloom
