// SPDX-License-Identifier: Apache-2.0
/// The picture of Gaussians on the screen (render/splat/camera_gaussians.h), front to back.
///
/// Of the Gaussians in the order of their depth (equal depths: of their rows), each pixel takes those whose α there is
/// at least 1/255, as long as its transmittance T (1 at first) is at least `stop_transmittance`:
///   α = min(0.99, o·exp(−½ dᵀ K d)),   colour += α T · colour of the Gaussian,   T ← (1 − α) T
/// The answer is this colour, premultiplied, and alpha = 1 − T; over a background b a picture is colour + (1 − alpha)
/// b.
/// Source: Kerbl et al., "3D Gaussian Splatting for Real-Time Radiance Field Rendering", SIGGRAPH 2023, eq. 3.
///
/// Only the pixels of the window are paid for. A pixel's value is a function of the Gaussians alone: the same bytes in
/// any window, for any number of threads and any instruction set. It is finite whatever the Gaussians hold, and so is
/// every alpha in [0, 1].
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "render/image/pixel_box.h"
#include "render/splat/camera_gaussians.h"
#include "render/splat/float_columns.h"
#include "render/splat/splat_tiles.h"

namespace bodyloom {

struct SplatPictureOptions {
  float stop_transmittance = 1.0F / 512;  ///< 0 to 1: what a pixel may let through and still be finished; 0: never
  int num_threads = 1;                    ///< 1 to 1024
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// What the last picture took.
struct SplatPictureSummary {
  int drawn = 0;         ///< Gaussians that meet the window
  int64_t meetings = 0;  ///< of a Gaussian and a tile
  double sort_seconds = 0, raster_seconds = 0;
};

/// Keeps its memory between pictures. Not for use by two threads at once.
class SplatPicture {
 public:
  enum Plane : int { kRed, kGreen, kBlue, kAlpha, kNumPlanes };

  /// Draws what meets the window, which may lie anywhere, also beyond the image. `screen` holds rows as
  /// ProjectGaussians makes them. Throws std::invalid_argument when the options are not valid or the window reaches
  /// beyond ±2^20 or has more than 2^27 pixels.
  void Draw(const ScreenGaussians& screen, const PixelBox& window, const SplatPictureOptions& options = {});

  [[nodiscard]] const PixelBox& window() const { return window_; }
  /// One float a pixel of the window, row-major.
  [[nodiscard]] std::span<const float> plane(Plane p) const { return planes_.values(p); }
  [[nodiscard]] const FloatColumns& planes() const { return planes_; }
  [[nodiscard]] const SplatPictureSummary& summary() const { return summary_; }

  /// The same picture of other values in place of colours, such as normals or shares of a label: `values` has three
  /// columns and as many rows as the Gaussians last drawn, `planes` gets three columns and a row a pixel. What
  /// ScreenGaussians promises of colours is asked of the values of those that are drawn: finite, within
  /// ±kLargestColour; else std::invalid_argument.
  void DrawValues(const FloatColumns& values, FloatColumns* planes);

  /// For render/splat/splat_gradient.h: what meets what, and the stop.
  [[nodiscard]] const splat_internal::SplatTiles& tiles() const { return tiles_; }
  [[nodiscard]] const SplatPictureOptions& options() const { return options_; }
  [[nodiscard]] int num_gaussians() const { return num_gaussians_; }

 private:
  void DrawTile(int tile, const splat_internal::Splat* other_splats, FloatColumns* planes) const;

  PixelBox window_;
  SplatPictureOptions options_;
  int num_gaussians_ = 0;
  splat_internal::SplatTiles tiles_;
  std::vector<splat_internal::Splat> with_values_;  ///< by row, of DrawValues
  FloatColumns planes_;
  SplatPictureSummary summary_;
};

}  // namespace bodyloom
