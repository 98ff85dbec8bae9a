// SPDX-License-Identifier: Apache-2.0
/// How folders of pictures name their frames.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace bodyloom {

/// "FOLDER/000012.png" of frame 12.
inline std::string FrameFile(const std::filesystem::path& folder, int t) {
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06d.png", t);
  return (folder / name.data()).string();
}

}  // namespace bodyloom
