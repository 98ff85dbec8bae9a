// SPDX-License-Identifier: Apache-2.0
/// Guesses values of unseen texels by the mean of the nearest seen ones, with left and right, and front and back, of
/// the body identified.
///
/// In a rest pose every texel lies in nested cells of 1, ½, ¼, … of the body's largest extent. Left is folded onto
/// right, and depth is ignored except on the head, whose back has no face: a sleeve takes the other sleeve's colours,
/// the back the front's, at the same height. Cells hold texels of one limb (or the torso, the head, a foot, a hand) of
/// either side. The guess is the mean of the seen texels in the smallest cell that has any; if the limb has none, of
/// all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bodyloom {

class TexelNeighbours {
 public:
  /// `texel_parts`: U × U, DensePose's part, 0 where the atlas is empty. `texel_places`: planar 3 × U × U, positions of
  /// the texels in the rest pose (x to a side, y up, z to the front; any unit). Throws std::invalid_argument for sizes
  /// that do not fit, parts above 24 and places that are not finite.
  TexelNeighbours(int texture_size, std::span<const uint8_t> texel_parts, std::span<const float> texel_places);

  /// Overwrites `values` (planar channels × U × U) at texels of the atlas with `shown` (U × U) 0 by the guess from
  /// those with 1. Returns U × U: 1 at overwritten texels; none when no texel is shown. O(channels × texels). Throws
  /// std::invalid_argument for arrays of other sizes.
  std::vector<uint8_t> FillUnseen(std::span<const uint8_t> shown, int channels, std::span<float> values) const;

  /// U × U: 1 for texels of the head; 1 for those behind the middle of its depth.
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
  std::vector<Level> levels_;  ///< the smallest cells first; the last level is one cell
};

}  // namespace bodyloom
