// SPDX-License-Identifier: Apache-2.0
/// The texture of a tracked person, gathered picture by picture of the video, merged and filled
/// (render/texture/texture_extract.h, render/texture/complete/uv_fill.h).
#pragma once

#include <optional>

#include "geometry/scene/track.h"
#include "render/texture/texture_extract.h"

namespace bodyloom {

/// What texels get that no frame shows: nothing, or the surface around them, carried on smoothly and across seams.
enum class TextureFill { kNone, kPyramid, kLaplace };

struct PersonTextureOptions {
  int size = 512;  ///< texels a side
  TextureExtractOptions::Merge merge = TextureExtractOptions::Merge::kMedian;
  TextureFill fill = TextureFill::kNone;
  double trust = 0.1;  ///< with a fill, texels seen worse than this (0 to 1) are filled, too
  /// Pixels around the body's contours that are not used, 0 to 64; -1: 1 % of the person's median height, because
  /// joints of a track are off by that much in the median frame.
  int margin_px = -1;
};

/// Colours of texels, bgr, and of each how well it was seen, as a grey value from 0 (never) to 255 (a pixel a texel,
/// from the front). Gutters are filled.
struct PersonTextureImages {
  Image colours, confidence;
  int texels_seen = 0;  ///< in at least one picture
};

class PersonTexture {
 public:
  /// Borrows both; `track` in the pictures' pixels (TrackVideo::Moved). Throws std::invalid_argument for a body without
  /// UV coordinates and options out of range.
  PersonTexture(const BodyModel& body, const Track& track, const PersonTextureOptions& options);

  /// Takes what the picture of frame t shows. False, and nothing is taken, where the track has no fit of its own: no
  /// pose, lost or interpolated frames. Throws std::invalid_argument for a picture of another size than the camera's.
  bool Add(int t, const Image& picture);

  /// Nothing when no texel was seen.
  [[nodiscard]] std::optional<PersonTextureImages> Merge() const;

  [[nodiscard]] int edge_margin_px() const { return margin_px_; }
  [[nodiscard]] int texels() const { return extractor_.table().num_inside; }  ///< that show the body

 private:
  const BodyModel& body_;
  const Track& track_;
  PersonTextureOptions options_;
  int margin_px_;
  TextureExtractor extractor_;
};

/// Whether PersonTexture takes a frame: it was fitted and has a pose.
bool HasFitOfItsOwn(const Track& track, int t);

}  // namespace bodyloom
