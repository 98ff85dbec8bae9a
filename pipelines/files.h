// SPDX-License-Identifier: Apache-2.0
/// Checks of the files a job was given, made before the long work rather than after it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bodyloom {

/// Throws std::runtime_error "path: ..." unless `path` is there and can be read (file or folder). Empty paths pass: an
/// option that was not given. `what` names the option's meaning, as in "detections".
void RequireReadable(const std::string& path, const std::string& what);

/// Throws std::runtime_error "path: ..." unless a file could be written at `path`: its folder is there, is writable and
/// has room, and `path` is no folder. Leaves whatever stands there untouched. Empty paths pass.
void RequireWritable(const std::string& path);

/// Creates the folder `path` (and those above it) when it is not there, and requires it to be writable.
void RequireWritableFolder(const std::string& path);

/// Throws RequestError when an output is the same file as an input or as another output. Empty paths are ignored.
void RequireDistinct(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

// Peak memory of a job.

/// Largest resident size of this process so far, bytes.
size_t PeakMemoryBytes();

}  // namespace bodyloom
