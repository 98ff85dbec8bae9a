// SPDX-License-Identifier: Apache-2.0
/// A guess at what pictures do not show of the body's surface: the mean of the nearest texels that they do show, where
/// both sides of the body and its front and back count as one place.
///
/// In a rest pose every texel lies in cells of 1, ½, ¼, … of the body's largest extent. Left is folded onto right, and
/// depth does not count but on the head, whose back has no face: a sleeve takes the other sleeve's colours, a back the
/// front's, at the same height. Cells hold texels of one limb (or the torso, the head, a foot, a hand) of either side.
/// The guess is the mean of the shown texels of the smallest cell that has any; where the limb shows nothing, of all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

class TexelNeighbours {
 public:
  /// `texel_parts`: U × U, DensePose's part, 0 where the atlas is empty. `texel_places`: planar 3 × U × U, where the
  /// texels lie in the rest pose (x to a side, y up, z to the front; only lengths' ratios count). Throws
  /// std::invalid_argument for sizes that do not fit, parts above 24 and places that are not finite.
  TexelNeighbours(int texture_size, std::span<const uint8_t> texel_parts, std::span<const float> texel_places);

  /// Overwrites `values` (planar channels × U × U) at the texels of the atlas where `shown` (U × U) is 0 with the guess
  /// made of those where it is 1. Returns U × U: 1 where it did; nowhere when nothing is shown. O(channels × texels).
  /// Throws std::invalid_argument for arrays of other sizes.
  std::vector<uint8_t> FillUnseen(std::span<const uint8_t> shown, int channels, std::span<float> values) const;

  /// U × U: 1 for texels of the head; of those behind the middle of its depth.
  [[nodiscard]] const std::vector<uint8_t>& head() const { return head_; }
  [[nodiscard]] const std::vector<uint8_t>& back_of_head() const { return back_of_head_; }
  [[nodiscard]] int texture_size() const { return texture_size_; }

 private:
  struct Level {
    std::vector<int> cell;  ///< by texel of texels_
    int num_cells = 0;
  };
  int texture_size_ = 0;
  std::vector<uint8_t> head_, back_of_head_;
  std::vector<int> texels_;    ///< of the atlas that show the body
  std::vector<Level> levels_;  ///< the smallest cells first; last one cell of everything
};

}  // namespace bodyloom
