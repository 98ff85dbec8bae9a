// SPDX-License-Identifier: Apache-2.0
/// Renders Gaussians on the screen (render/splat/camera_gaussians.h), front to back.
///
/// In the order of depth (equal depths: of rows), each pixel blends the Gaussians with α ≥ 1/255 as long as its
/// transmittance T (initially 1) is at least `stop_transmittance`:
///   α = min(0.99, o·exp(−½ dᵀ K d)),   colour += α T · colour of the Gaussian,   T ← (1 − α) T
/// The result is this premultiplied colour, and alpha = 1 − T; over a background b it is colour + (1 − alpha) b.
/// Source: Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", SIGGRAPH 2023, eq. 3.
///
/// Only pixels of the window are computed. A pixel's value depends on the Gaussians alone: the same bytes in any
/// window, for any number of threads and any instruction set. It is finite for any Gaussians, and alpha lies in [0, 1].
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "render/image/pixel_box.h"
#include "render/splat/camera_gaussians.h"
#include "render/splat/float_columns.h"
#include "render/splat/splat_tiles.h"

namespace bodyloom {

struct SplatImageOptions {
  float stop_transmittance = 1.0F / 512;  ///< 0 to 1: a pixel is finished below this transmittance; 0: never
  int num_threads = 1;                    ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Work and time of the last image.
struct SplatImageSummary {
  int drawn = 0;         ///< Gaussians that meet the window
  int64_t meetings = 0;  ///< pairs of Gaussian and tile
  double sort_seconds = 0, raster_seconds = 0;
};

/// Keeps its memory between images. Not for use by two threads at once.
class SplatImage {
 public:
  enum Plane : int { kRed, kGreen, kBlue, kAlpha, kNumPlanes };

  /// Draws the Gaussians that meet the window, which may lie outside the image. `screen`: from ProjectGaussians. Throws
  /// std::invalid_argument when the options are not valid or the window reaches beyond ±2^20 or has more than 2^27
  /// pixels.
  void Draw(const ScreenGaussians& screen, const PixelBox& window, const SplatImageOptions& options = {});

  [[nodiscard]] const PixelBox& window() const { return window_; }
  /// One float per pixel of the window, row-major.
  [[nodiscard]] std::span<const float> plane(Plane p) const { return planes_.values(p); }
  [[nodiscard]] const FloatColumns& planes() const { return planes_; }
  [[nodiscard]] const SplatImageSummary& summary() const { return summary_; }

  /// Draws the same image with other values instead of colours, such as normals or shares of a label: `values` has
  /// three columns and a row per Gaussian last drawn, `planes` receives three columns and a row per pixel. Values of
  /// drawn Gaussians must be finite and within ±kLargestColour, as colours are; else std::invalid_argument.
  void DrawValues(const FloatColumns& values, FloatColumns* planes);

  /// For render/splat/splat_gradient.h: pairs of Gaussians and tiles, and the stop.
  [[nodiscard]] const splat_internal::SplatTiles& tiles() const { return tiles_; }
  [[nodiscard]] const SplatImageOptions& options() const { return options_; }
  [[nodiscard]] int num_gaussians() const { return num_gaussians_; }

 private:
  void DrawTile(int tile, const splat_internal::Splat* other_splats, FloatColumns* planes) const;

  PixelBox window_;
  SplatImageOptions options_;
  int num_gaussians_ = 0;
  splat_internal::SplatTiles tiles_;
  std::vector<splat_internal::Splat> with_values_;  ///< by row, for DrawValues
  FloatColumns planes_;
  SplatImageSummary summary_;
};

}  // namespace bodyloom
