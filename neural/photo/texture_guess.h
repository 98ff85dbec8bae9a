// SPDX-License-Identifier: Apache-2.0
/// A guess at what a picture does not show of the body's texture: the colours of the nearest texels that it does show,
/// where both sides of the body and its front and back count as one place.
///
/// In a rest pose every texel lies in cells of 1, ½, ¼, … of the body's largest extent. Left is folded onto right, and
/// depth does not count but on the head, whose back has no face: a sleeve takes the other sleeve's colours, a back the
/// front's, at the same height. Cells hold texels of one limb (or the torso, the head, a foot, a hand) of either side.
/// The guess is the mean of the shown texels of the smallest cell that has any; where the limb shows nothing, of all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "neural/photo/partial_texture.h"

namespace bodyloom {

class TextureGuess {
 public:
  /// `texel_parts`: U × U, DensePose's part, 0 where the atlas is empty. `texel_places`: planar 3 × U × U, where the
  /// texels lie in the rest pose (x to a side, y up, z to the front; only lengths' ratios count). Throws
  /// std::invalid_argument for sizes that do not fit, parts above 24 and places that are not finite.
  TextureGuess(int texture_size, std::span<const uint8_t> texel_parts, std::span<const float> texel_places);

  /// Fills `colour` and `guessed` where the atlas has a texel that is not visible; a texture that shows nothing stays
  /// as it is. O(texels). Throws std::invalid_argument for a texture of another size.
  void Fill(PartialTexture* texture) const;

 private:
  struct Level {
    std::vector<int> cell;  ///< by texel of texels_
    int num_cells = 0;
  };
  int texture_size_ = 0;
  std::vector<int> texels_;    ///< of the atlas that show the body
  std::vector<Level> levels_;  ///< the smallest cells first; last one cell of everything
};

}  // namespace bodyloom
