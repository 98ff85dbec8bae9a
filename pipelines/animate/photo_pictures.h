// SPDX-License-Identifier: Apache-2.0
/// Requested pictures out of stills, folders and videos.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data_tools/video/photo_file.h"

namespace bodyloom {

struct PictureRequest {
  std::string path;  ///< a picture, a video or a folder of pictures
  int frame = 0;     ///< of a video or folder; a still has one picture for every number
};

/// In the order of the requests. A video is decoded once, as far as the last frame requested from it. Throws
/// std::runtime_error naming the file that cannot be read or has no such frame.
std::vector<PhotoFile> ReadPictures(std::span<const PictureRequest> requests);

}  // namespace bodyloom
