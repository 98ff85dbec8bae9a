// SPDX-License-Identifier: Apache-2.0
/// A photograph as people have it: what of a file's colours, depth and transparency is kept, and what is not.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct PhotoFile {
  Image image;  ///< upright, eight bits a channel; what is transparent is laid over white
  /// Width × height, 0 transparent to 255; empty where the file has no transparency, or nothing or everything is
  /// transparent.
  std::vector<uint8_t> alpha;
  /// What was not as usual, each half a sentence for the user: "grey-scale: …", "16 bits a channel: …", "CMYK: …",
  /// "transparent: …".
  std::vector<std::string> notes;
};

/// A still that image_file.h reads. Throws std::runtime_error naming the file when it cannot be decoded, and for a JPEG
/// or PNG that ends before its picture does (what is missing would be decoded as grey or black).
PhotoFile ReadPhoto(const std::string& path);

}  // namespace bodyloom
