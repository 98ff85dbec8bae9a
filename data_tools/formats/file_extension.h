// SPDX-License-Identifier: Apache-2.0
/// The kind of a file by its name.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace bodyloom {

/// ".jpg" of "Photo.JPG"; empty when the name has none.
inline std::string LowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace bodyloom
