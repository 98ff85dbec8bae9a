// SPDX-License-Identifier: Apache-2.0
/// Checks of a job's input and output files, made before any long computation.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bodyloom {

/// Throws std::runtime_error "path: ..." unless `path` exists and is readable (file or folder). Empty paths, of options
/// not given, pass. `what` names the option's meaning, as in "detections".
void RequireReadable(const std::string& path, const std::string& what);

/// The same for a body given as a file, or by the name of a built-in one (data_tools/body/builtin_body.h).
void RequireReadableBody(const std::string& body);

/// Throws std::runtime_error "path: ..." unless a file could be written at `path`: its folder exists, is writable and
/// has free space, and `path` is not a folder. Existing files are left untouched. Empty paths pass.
void RequireWritable(const std::string& path);

/// Creates the folder `path` and its parents if missing, and requires it to be writable.
void RequireWritableFolder(const std::string& path);

/// Throws RequestError when an output is the same file as an input or as another output. Empty paths are ignored.
void RequireDistinct(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// Maximum resident size of this process so far, bytes.
size_t PeakMemoryBytes();

/// Returns freed memory to the system where the C library is glibc, which keeps what was allocated in small pieces: of
/// detections of a long clip some hundred megabytes. Elsewhere does nothing.
void ReturnFreedMemory();

}  // namespace bodyloom
