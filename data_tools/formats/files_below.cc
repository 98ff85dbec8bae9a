// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/formats/files_below.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace bodyloom {

std::vector<std::string> FilesBelow(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error)) return {path};
  std::vector<std::string> files;
  fs::recursive_directory_iterator entry(path, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code not_a_file;
    if (entry->is_regular_file(not_a_file)) files.push_back(entry->path().string());
  }
  if (error) throw std::runtime_error(path + ": the folder cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace bodyloom
