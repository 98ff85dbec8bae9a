// SPDX-License-Identifier: Apache-2.0
/// Reads photographs with arbitrary colours, depth and transparency, and notes what was converted or lost.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

struct PhotoFile {
  Image image;  ///< upright, eight bits per channel; transparent pixels are composited over white
  /// Width × height, 0 transparent to 255; empty if the file has no transparency, or no or all pixels are transparent.
  std::vector<uint8_t> alpha;
  /// Deviations from a plain 8-bit RGB image, each half a sentence for the user: "grey-scale: …", "16 bits a channel:
  /// …", "CMYK: …", "transparent: …".
  std::vector<std::string> notes;
};

/// Reads a still image of a format of image_file.h. Throws std::runtime_error naming the file when it cannot be
/// decoded, and for a truncated JPEG or PNG (the missing part would be decoded as grey or black).
PhotoFile ReadPhoto(const std::string& path);

}  // namespace bodyloom
