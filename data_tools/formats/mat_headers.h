// SPDX-License-Identifier: Apache-2.0
/// Checks a MATLAB file before libmatio opens it: that library allocates whatever size a header claims, so 160 bytes
/// could request gigabytes.
#pragma once

#include <string>

namespace bodyloom {

/// Walks the variables of a MATLAB version 5 file (MAT-File Format, MathWorks, chapter 1): each must lie inside the
/// file and be a numeric matrix of at most 16 dimensions with a name of at most 63 characters, plain or compressed. The
/// values are not read. Throws std::runtime_error naming the file, the byte where the variable begins and what was
/// expected; also for files of another version.
void CheckMatHeaders(const std::string& path);

}  // namespace bodyloom
