// SPDX-License-Identifier: Apache-2.0
/// Inputs of the one-photo renderers from a tracked person: surface coordinates and part of every pixel of a square
/// window around the body, and the pixel at which each texel of the UV atlas appears.
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
  std::vector<double> yaw_deg;  ///< per frame, rotation of the view (PersonFramesOptions::yaw_deg); empty: none
  /// Surface coordinates of the pixels of all frames from estimates; null: those of the tracked body, which determines
  /// the window in either case. With estimates the cosine of a visible texel is 1. Not with yaw_deg.
  std::shared_ptr<const EstimatedPixels> estimated;
  /// Texels of the body at that size, to share them between clips of one body; null: computed.
  std::shared_ptr<const UvTexelTable> texels;
  int num_threads = 1;
};

/// U × U: DensePose's part of each texel (gutters too), 0 where the atlas is empty.
std::vector<uint8_t> PartsOfTexels(const BodyModel& body, const UvTexelTable& texels);

/// Planar 3 × U × U: position of each texel on the body's template, metres; 0 where the atlas is empty.
std::vector<float> PlacesOfTexels(const BodyModel& body, const UvTexelTable& texels);

/// Planar.
struct PhotoMap {
  std::vector<float> uv;            ///< 2 × S × S: atlas coordinates; 0 off the body
  std::vector<uint8_t> parts;       ///< S × S: DensePose's part 1–24; 0 off the body
  std::vector<float> texel_pixels;  ///< 2 × U × U: x, y in the window where the texel's point appears; 0 if hidden
  std::vector<float> texel_cosine;  ///< U × U: of the angle between normal and line of sight; 0 if hidden
};

class PhotoMaps {
 public:
  /// Keeps references to body and track. Throws std::invalid_argument when sizes are invalid, the body has no parts or
  /// atlas, the track does not fit the body, or no frame shows it.
  PhotoMaps(const BodyModel& body, const Track& track, const PhotoMapsOptions& options);
  ~PhotoMaps();
  PhotoMaps(PhotoMaps&&) noexcept;

  [[nodiscard]] const PersonWindow& window() const;  ///< S × S
  /// May be called by several threads. A frame without a result has no visible texels.
  [[nodiscard]] PhotoMap At(int t) const;
  [[nodiscard]] const std::shared_ptr<const UvTexelTable>& texels() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// Image positions of a body's texels from the surface coordinates of pixels: the inverse of an IUV image.

struct TexelPlaces {
  std::vector<float> pixels;  ///< 2 × U × U: x and y in the image where the texel's point appears; 0: hidden
  std::vector<float> seen;    ///< U × U: 1 where it is visible, else 0
};

/// `uv`: atlas coordinates, 2 × height × width; `parts`: DensePose's, 0 off the body. `texel_parts` (U × U): the part
/// of each texel. Positions are interpolated in each triangle of neighbouring pixels of one part that are within 0.1 of
/// each other in the atlas, and extrapolated by half a pixel at the rim, so a texel is visible where pixels around it
/// show its part. Of several positions an interpolated one takes precedence, then the uppermost, then the leftmost.
/// Throws std::invalid_argument when sizes differ.
TexelPlaces TexelsOfPixels(std::span<const float> uv, std::span<const uint8_t> parts, int width, int height,
                           std::span<const uint8_t> texel_parts, int texture_size);

}  // namespace bodyloom
