// SPDX-License-Identifier: Apache-2.0
/// Relights a rendered person: estimates the original light from the rendered frames and replaces it by a requested
/// one.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "neural/motion/motion_frame.h"
#include "render/lighting/fit_lighting.h"
#include "render/lighting/sh_lighting.h"

namespace bodyloom {

/// The light requested by a file. Brightness is relative: light of strength 1 from all directions leaves the person's
/// mean brightness unchanged.
struct RelightRequest {
  ShLighting light = ShLighting::Zero();  ///< camera frame
  bool estimate = true;                   ///< false: the frames are assumed to be evenly lit
  PixelEncoding encoding = PixelEncoding::kSrgb;
};

/// Reads an environment (.png, .jpg, …: equirectangular, sRGB, its mean luminance becoming 1), or JSON:
///   {"directional": [{"from": [x, y, z], "intensity": 1, "colour": [r, g, b]}, …], "ambient": 0.2,
///    "estimate": true, "encoding": "srgb"}
/// `from` points to the light in the viewer's axes (right, up, towards the viewer). Only "directional" or "ambient" is
/// needed. Throws std::runtime_error naming the file and the place.
RelightRequest ReadRelight(const std::string& path);

/// Collects pixels of rendered frames, estimates the light in them, and relights frames.
class FrameRelighter {
 public:
  static constexpr int kFrames = 64;  ///< maximum number used by the estimate

  explicit FrameRelighter(RelightRequest request) : request_(std::move(request)) {}

  [[nodiscard]] bool wants_frames() const { return request_.estimate; }
  /// Adds a frame to the estimate: its pixels with alpha of at least 0.9 and a normal.
  void Observe(const MotionImage& image);
  /// Estimates the light of the observed frames. If the fit is not usable, the frames are assumed to be evenly lit;
  /// summary() says so.
  void Estimate();
  /// Relights an image in place; call after Estimate() where wants_frames(). Throws std::invalid_argument without
  /// normals.
  void Apply(MotionImage* image) const;

  [[nodiscard]] const FitLightingSummary& summary() const { return fit_.summary; }
  [[nodiscard]] nlohmann::ordered_json Json() const;

 private:
  RelightRequest request_;
  ShLighting old_light_ = AmbientLight({1, 1, 1});
  FitLightingResult fit_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<double> light_;
  std::vector<uint8_t> labels_;
};

}  // namespace bodyloom
