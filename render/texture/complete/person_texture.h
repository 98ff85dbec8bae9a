// SPDX-License-Identifier: Apache-2.0
/// Builds the texture of a tracked person from the frames of the video: gathered, merged and filled
/// (render/texture/texture_extract.h, render/texture/complete/uv_fill.h).
#pragma once

#include <optional>

#include "geometry/scene/track.h"
#include "render/texture/texture_extract.h"

namespace bodyloom {

/// Filling of unseen texels: none, or smooth continuation of the surrounding surface, also across seams.
enum class TextureFill { kNone, kPyramid, kLaplace };

struct PersonTextureOptions {
  int size = 512;  ///< texels per side
  TextureExtractOptions::Merge merge = TextureExtractOptions::Merge::kMedian;
  TextureFill fill = TextureFill::kNone;
  double trust = 0.1;  ///< with a fill, texels of lower confidence (0 to 1) are filled, too
  /// Pixels around the body's contours that are not used, 0 to 64; -1: 1 % of the person's median height, the median
  /// error of a track's joints.
  int margin_px = -1;
};

/// Colours of texels, bgr, and their confidence as a grey value from 0 (never seen) to 255 (frontal, one pixel per
/// texel). Gutters are filled.
struct PersonTextureImages {
  Image colours, confidence;
  int texels_seen = 0;  ///< in at least one image
};

class PersonTexture {
 public:
  /// Borrows both; `track` is in pixels of the images (TrackVideo::Moved). Throws std::invalid_argument for a body
  /// without UV coordinates and options out of range.
  PersonTexture(const BodyModel& body, const Track& track, const PersonTextureOptions& options);

  /// Adds the image of frame t. Returns false, without adding, if the track has no fit of its own there: no pose, lost
  /// or interpolated frames. Throws std::invalid_argument for an image of another size than the camera's.
  bool Add(int t, const Image& image);

  /// Merges the samples; empty when no texel was seen.
  [[nodiscard]] std::optional<PersonTextureImages> Merge() const;

  [[nodiscard]] int edge_margin_px() const { return margin_px_; }
  [[nodiscard]] int texels() const { return extractor_.table().num_inside; }  ///< texels of the body

 private:
  const BodyModel& body_;
  const Track& track_;
  PersonTextureOptions options_;
  int margin_px_;
  TextureExtractor extractor_;
};

/// Returns true if PersonTexture accepts a frame: it was fitted and has a pose.
bool HasFitOfItsOwn(const Track& track, int t);

}  // namespace bodyloom
