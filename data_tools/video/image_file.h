// SPDX-License-Identifier: Apache-2.0
/// Still images: PNG, JPEG, BMP, WebP and TIFF in; PNG and JPEG out.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/render/image.h"

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

}  // namespace bodyloom
