// SPDX-License-Identifier: Apache-2.0
/// The background of an animated person: a picture, a video that is played to and fro no further than its end, or a
/// plain backdrop.
#pragma once

#include <memory>
#include <string>

#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

/// What stands behind a person who is rendered from a photo.
struct PhotoBackground {
  bool own = true;   ///< the photo's own, filled in where the person stood
  std::string path;  ///< else an image, a video or a folder; empty: a plain backdrop
};

/// The middle of an image at width × height, as much of it as fills that; nothing is stretched.
Image Covering(const Image& image, int width, int height);

class Background {
 public:
  /// `path`: an image, a video or a folder of images (Covering()); empty: a studio's backdrop. Throws
  /// std::runtime_error naming it.
  Background(const std::string& path, int width, int height);

  /// The next frame, width × height; a video that has ended keeps its last frame.
  const Image& Next();

 private:
  int width_, height_;
  std::unique_ptr<VideoReader> video_;
  Image image_;
};

}  // namespace bodyloom
