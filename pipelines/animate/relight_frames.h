// SPDX-License-Identifier: Apache-2.0
/// Other light on a rendered person: the light that was, from the frames themselves, and the light that shall be.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "neural/motion/motion_frame.h"
#include "render/lighting/fit_lighting.h"
#include "render/lighting/sh_lighting.h"

namespace bodyloom {

/// The light that a file requests. Brightness is relative: light of strength 1 from everywhere leaves the person, on
/// the average, as bright as it is.
struct RelightRequest {
  ShLighting light = ShLighting::Zero();  ///< camera frame
  bool estimate = true;                   ///< false: the frames are taken as evenly lit
  PixelEncoding encoding = PixelEncoding::kSrgb;
};

/// An environment (.png, .jpg, …: equirectangular, sRGB, its mean luminance becoming 1), or JSON:
///   {"directional": [{"from": [x, y, z], "intensity": 1, "colour": [r, g, b]}, …], "ambient": 0.2,
///    "estimate": true, "encoding": "srgb"}
/// `from` points to the light in the viewer's axes (right, up, towards the viewer). Only "directional" or "ambient" is
/// needed. Throws std::runtime_error naming the file and the place.
RelightRequest ReadRelight(const std::string& path);

/// Gathers pixels of rendered frames, finds the light in them, and relights frames.
class FrameRelighter {
 public:
  static constexpr int kFrames = 64;  ///< that the estimate looks at, at most

  explicit FrameRelighter(RelightRequest request) : request_(std::move(request)) {}

  [[nodiscard]] bool wants_frames() const { return request_.estimate; }
  /// A frame for the estimate: its pixels with alpha of at least 0.9 and a normal.
  void Observe(const MotionPicture& picture);
  /// From the frames observed. A fit that is not usable leaves the frames taken as evenly lit; summary() says so.
  void Estimate();
  /// In place; only after Estimate() where wants_frames(). Pictures without normals: std::invalid_argument.
  void Apply(MotionPicture* picture) const;

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
