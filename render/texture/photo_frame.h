// SPDX-License-Identifier: Apache-2.0
/// One picture of a person as the one-photo renderers (neural/photo, neural/guided) take it: a square window around the
/// person, what each pixel sees of the body, and where each texel of the body appears.
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
  /// U × U: where the texel's point is on the surface, in the window and hidden by nothing of the body, the cosine of
  /// the angle between the surface's normal and the line of sight; 0 where it is not seen.
  std::vector<float> texel_cosine;

  // What a picture shows; empty where there is no picture (a pose to be rendered).
  std::vector<float> image;     ///< 3 × S × S RGB in [0, 1], 0 on the background
  std::vector<uint8_t> labels;  ///< S × S: 0 background, 1 top, 2 bottom, 3 face, 4 hair, 5 skin, 6 shoes
};

inline constexpr int kPhotoLabels = 7, kPhotoParts = 25;
inline constexpr uint8_t kFaceLabel = 3, kHairLabel = 4, kSkinLabel = 5;

/// What pictures of one person have in common: those of one pose show the same moment, those of one view were taken
/// from the same side.
struct PicturePlace {
  int pose = 0, view = 0;
};

/// Pictures of several people. Fill may be called by any thread, one call at a time a thread.
struct PhotoSource {
  std::vector<int> num_frames;  ///< by person
  /// By person and frame; empty: nobody knows, and any two pictures are of different poses and views.
  std::vector<std::vector<PicturePlace>> places;
  int size = 0, texture_size = 0;    ///< of all frames
  std::vector<uint8_t> texel_parts;  ///< U × U: DensePose's part of each texel, 0 where the atlas is empty
  /// Planar 3 × U × U: where each texel lies on the body at rest (x to its left, y up, z to its front, metres), 0 where
  /// the atlas is empty. May be empty where it is not needed.
  std::vector<float> texel_places;
  std::function<void(int person, int frame, PhotoFrame*)> fill;
};

}  // namespace bodyloom
