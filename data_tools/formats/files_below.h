// SPDX-License-Identifier: Apache-2.0
/// The files of a folder and of all folders below it.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Every regular file below the folder, sorted by path, so that the same folder gives the same order everywhere; a
/// path that is no folder is returned as it is. Folders behind symbolic links are not entered. Throws
/// std::runtime_error naming the folder when it, or one below it, cannot be read.
std::vector<std::string> FilesBelow(const std::string& path);

}  // namespace bodyloom
