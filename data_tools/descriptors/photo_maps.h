// SPDX-License-Identifier: Apache-2.0
/// A tracked person as the one-photo renderers see it: in a square window around the body, the surface coordinates and
/// part of every pixel, and for every texel of the UV atlas the pixel where it appears.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "data_tools/descriptors/estimated_pixels.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/view/person_window.h"

namespace bodyloom {

struct PhotoMapsOptions {
  int size = 256;               ///< S: pixels of the window's sides
  int texture_size = 256;       ///< U: texels of the atlas' sides
  double margin = 0.15;         ///< around the body (PersonWindowOptions::margin)
  std::vector<double> yaw_deg;  ///< by frame: turns the view (PersonFramesOptions::yaw_deg); empty: the track's own
  /// What pixels show of the body by estimates from the pictures, of all frames; null: what the tracked body says,
  /// which places the window in either case. With estimates a texel that is seen has the cosine 1. Not with yaw_deg.
  std::shared_ptr<const EstimatedPixels> estimated;
  /// Texels of the body at that size, when a caller has them already (many clips of one body); null: made.
  std::shared_ptr<const UvTexelTable> texels;
  int num_threads = 1;
};

/// U × U: DensePose's part of each texel (gutters too), 0 where the atlas is empty.
std::vector<uint8_t> PartsOfTexels(const BodyModel& body, const UvTexelTable& texels);

/// Planar 3 × U × U: where each texel lies on the body's template, metres; 0 where the atlas is empty.
std::vector<float> PlacesOfTexels(const BodyModel& body, const UvTexelTable& texels);

/// Planar.
struct PhotoMap {
  std::vector<float> uv;            ///< 2 × S × S: atlas coordinates; 0 off the body
  std::vector<uint8_t> parts;       ///< S × S: DensePose's part 1–24; 0 off the body
  std::vector<float> texel_pixels;  ///< 2 × U × U: x, y in the window where the texel's point appears; 0 if not seen
  std::vector<float> texel_cosine;  ///< U × U: of the angle between normal and line of sight; 0 if not seen
};

class PhotoMaps {
 public:
  /// Keeps references to body and track. Throws std::invalid_argument when sizes make no sense, the body has no parts
  /// or atlas, the track is not the body's, or no frame shows it.
  PhotoMaps(const BodyModel& body, const Track& track, const PhotoMapsOptions& options);
  ~PhotoMaps();
  PhotoMaps(PhotoMaps&&) noexcept;

  [[nodiscard]] const PersonWindow& window() const;  ///< S × S
  /// May be called by several threads. A frame without a result is empty: nothing seen.
  [[nodiscard]] PhotoMap At(int t) const;
  [[nodiscard]] const std::shared_ptr<const UvTexelTable>& texels() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// Where the texels of a body appear in a picture, from what its pixels show: the inverse of an IUV image.

struct TexelPlaces {
  std::vector<float> pixels;  ///< 2 × U × U: x and y in the picture where the texel's point appears; 0: not seen
  std::vector<float> seen;    ///< U × U: 1, or 0 where it is not seen
};

/// `uv`: atlas coordinates, 2 × height × width; `parts`: DensePose's, 0 off the body. `texel_parts` (U × U): the part
/// of each texel. Between each three neighbouring pixels of one part that are near each other in the atlas (0.1),
/// places are interpolated, and continued by half a pixel at the rim; so a texel is seen where pixels around it show
/// its part. Of two places the interpolated one counts, then the upper, then the left one. Throws std::invalid_argument
/// when sizes differ.
TexelPlaces TexelsOfPixels(std::span<const float> uv, std::span<const uint8_t> parts, int width, int height,
                           std::span<const uint8_t> texel_parts, int texture_size);

}  // namespace bodyloom
