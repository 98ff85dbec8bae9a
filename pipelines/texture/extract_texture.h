// SPDX-License-Identifier: Apache-2.0
/// Extracts the tracked person's texture from the frames of the video (render/texture/texture_extract.h).
#pragma once

#include <string>

#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "render/texture/complete/person_texture.h"

namespace bodyloom {

struct ExtractTextureRequest {
  std::string track;       ///< .npz
  std::string video;       ///< the video, or a folder of images
  std::string body;        ///< the track's body; empty: the built-in one
  std::string out;         ///< the texture, .png or .jpg
  std::string confidence;  ///< visibility of each texel as a grey image; empty: none
  std::string json;        ///< ToJson(ExtractTextureReport); empty: none
  int every = 1;           ///< use every n-th frame
  PersonTextureOptions texture;
};

struct ExtractTextureReport {
  std::string out;              ///< the texture
  int width = 0, height = 0;    ///< texels
  int track_frames = 0;         ///< frames of the track
  int frames_used = 0;          ///< seen by a texel
  int frames_without_fit = 0;   ///< lost or only interpolated, left out
  int frames_beyond_video = 0;  ///< past the end of the video
  int edge_margin_px = 0;       ///< as used
  int texels = 0;               ///< texels of the body
  int texels_seen = 0;          ///< of them, seen in at least one frame
  bool filled = false;
  StageSeconds seconds;
  double total_seconds = 0;
};

/// Extracts, merges, fills and writes the texture. Throws std::runtime_error naming a file that cannot be used, for a
/// body without UV coordinates or a clip in which the body is never seen; RequestError for a file both read and
/// written; Cancelled.
ExtractTextureReport ExtractTexture(const ExtractTextureRequest& request, const PipelineCallbacks& callbacks = {});

/// Several lines of text ending in a newline.
std::string ToText(const ExtractTextureReport& report);
/// The same as one JSON object.
std::string ToJson(const ExtractTextureReport& report);

}  // namespace bodyloom
