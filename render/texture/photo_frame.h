// SPDX-License-Identifier: Apache-2.0
/// Input of the one-photo renderers (neural/photo, neural/guided): a square window around a person, the body's surface
/// point at each pixel, and the pixel of each of the body's texels.
///
/// Images are planar (channel, row, column). Atlas coordinates and texels are those of the body's one packed UV layout:
/// texel (row r, column c) of a U×U map is centred at u = (c + ½)/U, v = 1 − (r + ½)/U.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace bodyloom {

struct PhotoFrame {
  int size = 0;                ///< width and height S of the window
  std::vector<float> uv;       ///< 2 × S × S: atlas coordinates of the bare body in [0, 1]; 0 off the body
  std::vector<uint8_t> parts;  ///< S × S: DensePose's part 1–24 of the bare body; 0 off the body

  int texture_size = 0;             ///< U
  std::vector<float> texel_pixels;  ///< 2 × U × U: x and y in the window where the texel's point appears
  /// U × U: cosine between the surface's normal and the line of sight at texels that are on the surface, in the window
  /// and not occluded by the body; 0 elsewhere.
  std::vector<float> texel_cosine;

  // Empty without an image (a pose to be rendered).
  std::vector<float> image;     ///< 3 × S × S RGB in [0, 1], 0 on the background
  std::vector<uint8_t> labels;  ///< S × S: 0 background, 1 top, 2 bottom, 3 face, 4 hair, 5 skin, 6 shoes
};

inline constexpr int kPhotoLabels = 7, kPhotoParts = 25;
inline constexpr uint8_t kFaceLabel = 3, kHairLabel = 4, kSkinLabel = 5;

/// Pose and view of an image: images of one pose show the same moment, those of one view were taken from the same side.
struct ImagePlace {
  int pose = 0, view = 0;
};

/// Images of several people. fill may be called from any thread.
struct PhotoSource {
  std::vector<int> num_frames;  ///< by person
  /// By person and frame; empty: not known, and all images are of different poses and views.
  std::vector<std::vector<ImagePlace>> places;
  int size = 0, texture_size = 0;    ///< of all frames
  std::vector<uint8_t> texel_parts;  ///< U × U: DensePose's part of each texel, 0 where the atlas is empty
  /// Planar 3 × U × U: position of each texel on the body at rest (x to its left, y up, z to its front, metres), 0
  /// where the atlas is empty. May be empty if not needed.
  std::vector<float> texel_places;
  std::function<void(int person, int frame, PhotoFrame*)> fill;
};

}  // namespace bodyloom
