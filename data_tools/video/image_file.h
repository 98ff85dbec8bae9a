// SPDX-License-Identifier: Apache-2.0
/// Still images: PNG, JPEG, BMP, WebP and TIFF in; PNG and JPEG out.
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

/// Whether a file is named as a still image: .png .jpg .jpeg .bmp .webp .tif .tiff, in any case.
bool IsImageName(const std::string& path);

/// Throws std::runtime_error naming the file when it cannot be read or is no image of 1 to 2^26 pixels.
Image ReadImage(const std::string& path);

/// ReadImage in its two halves, for who looks at the file's bytes too: at most 2^28 of them; `path` is for messages.
std::string ReadImageBytes(const std::string& path);
Image DecodeImage(const std::string& bytes, const std::string& path);

/// By the extension: .png, or .jpg/.jpeg (quality 95). Whole or not at all. Throws std::runtime_error naming the file,
/// std::invalid_argument for an empty image.
void WriteImage(const std::string& path, const Image& image);
/// The bytes that WriteImage writes; `path` is for the extension and messages.
std::string EncodeImage(const Image& image, const std::string& path);

/// The image files of a folder (.png .jpg .jpeg .bmp .webp .tif .tiff), numbers in names compared as numbers, so that
/// frame_2 comes before frame_10; hidden files are passed over. Throws std::runtime_error when there are none.
std::vector<std::string> ImageFilesOf(const std::string& folder);

// How folders of pictures name their frames.

/// "FOLDER/000012.png" of frame 12.
inline std::string FrameFile(const std::filesystem::path& folder, int t) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06d.png", t);
  return (folder / name.data()).string();
}

// Pictures with transparency.

/// An 8-bit PNG of blue, green, red (straight, not multiplied by alpha) and alpha, four bytes a pixel in rows from the
/// top. Whole or not at all. Throws std::invalid_argument for another number of bytes than the size asks for,
/// std::runtime_error naming the path.
void WriteAlphaPng(const std::string& path, int width, int height, std::span<const uint8_t> bgra);

}  // namespace bodyloom
