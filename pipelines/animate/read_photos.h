// SPDX-License-Identifier: Apache-2.0
/// Reads requested images from stills, folders and videos.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data_tools/video/image_file.h"

namespace bodyloom {

struct ImageRequest {
  std::string path;  ///< an image, a video or a folder of images
  int frame = 0;     ///< of a video or folder; ignored for a still
};

/// Images in the order of the requests. A video is decoded once, up to the last frame requested from it. Throws
/// std::runtime_error naming the file that cannot be read or has no such frame.
std::vector<PhotoFile> ReadImages(std::span<const ImageRequest> requests);

}  // namespace bodyloom
