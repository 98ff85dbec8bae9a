// SPDX-License-Identifier: Apache-2.0
/// Reads still images (PNG, JPEG, BMP, WebP, TIFF) and writes PNG and JPEG.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "render/image/image.h"

namespace bodyloom {

/// Returns true if a file name has the extension of a still image: .png .jpg .jpeg .bmp .webp .tif .tiff, in any case.
bool IsImageName(const std::string& path);

/// Throws std::runtime_error naming the file when it cannot be read or is not an image of 1 to 2^26 pixels.
Image ReadImage(const std::string& path);

/// The two steps of ReadImage, for callers that also need the file's bytes: at most 2^28 of them; `path` is for
/// messages.
std::string ReadImageBytes(const std::string& path);
Image DecodeImage(const std::string& bytes, const std::string& path);

/// Writes an image in the format of the extension: .png, or .jpg/.jpeg (quality 95). Atomic. Throws std::runtime_error
/// naming the file, std::invalid_argument for an empty image.
void WriteImage(const std::string& path, const Image& image);
/// The bytes that WriteImage writes; `path` is for the extension and messages.
std::string EncodeImage(const Image& image, const std::string& path);

/// The image files of a folder (.png .jpg .jpeg .bmp .webp .tif .tiff), sorted with numbers in names compared by value,
/// so that frame_2 comes before frame_10; hidden files are skipped. Throws std::runtime_error when there are none.
std::vector<std::string> ImageFilesOf(const std::string& folder);

// File names of the frames in folders of images.

/// "FOLDER/000012.png" of frame 12.
inline std::string FrameFile(const std::filesystem::path& folder, int t) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06d.png", t);
  return (folder / name.data()).string();
}

// Images with transparency.

/// Writes an 8-bit PNG of blue, green, red (not premultiplied by alpha) and alpha, four bytes per pixel in rows from
/// the top, atomically. Throws std::invalid_argument when the number of bytes does not match the size,
/// std::runtime_error naming the path.
void WriteAlphaPng(const std::string& path, int width, int height, std::span<const uint8_t> bgra);

// Reads photographs with arbitrary colours, depth and transparency, and notes what was converted or lost.

struct PhotoFile {
  Image image;  ///< upright, eight bits per channel; transparent pixels are composited over white
  /// Width × height, 0 transparent to 255; empty if the file has no transparency, or no or all pixels are transparent.
  std::vector<uint8_t> alpha;
  /// Deviations from a plain 8-bit RGB image, each half a sentence for the user: "grey-scale: …", "16 bits a channel:
  /// …", "CMYK: …", "transparent: …".
  std::vector<std::string> notes;
};

/// Reads a still image of one of these formats. Throws std::runtime_error naming the file when it cannot be
/// decoded, and for a truncated JPEG or PNG (the missing part would be decoded as grey or black).
PhotoFile ReadPhoto(const std::string& path);

}  // namespace bodyloom
