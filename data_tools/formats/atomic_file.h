// SPDX-License-Identifier: Apache-2.0
/// Atomic writing of files: temporary file beside the target → write → fsync → rename → fsync of the folder.
#pragma once

#include <cctype>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace bodyloom {

/// Error when the disk, the quota or the file-size limit is exhausted.
class DiskFullError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws "path: cannot ACTION: " with the text of errno: DiskFullError, or else std::runtime_error.
[[noreturn]] void ThrowSystemError(const std::string& path, const std::string& action);

/// Returns the whole contents of a file. Throws std::runtime_error with path and reason, also above max_bytes.
std::string ReadFileBytes(const std::string& path, size_t max_bytes = size_t{1} << 32);

/// Writes `bytes` to `path` atomically. Throws std::runtime_error with path and reason (no folder, no permission, disk
/// full: DiskFullError); on failure an existing file at `path` is unchanged and no temporary file remains.
void WriteFileAtomically(const std::string& path, const std::string& bytes);

/// For writers that need a path (video encoders): provides a temporary path beside the target with the same extension;
/// Commit() fsyncs and renames; the destructor removes the temporary when Commit was not called.
class AtomicPath {
 public:
  explicit AtomicPath(std::string target);
  ~AtomicPath();
  AtomicPath(const AtomicPath&) = delete;
  AtomicPath& operator=(const AtomicPath&) = delete;
  [[nodiscard]] const std::string& temporary() const { return temporary_; }
  void Commit();

 private:
  std::string target_, temporary_;
  bool committed_ = false;
};

// Files of a folder and of all folders below it.

/// Every regular file below the folder, sorted by path, so that the order is the same everywhere; a path that is not a
/// folder is returned itself. Folders behind symbolic links are not entered. Throws std::runtime_error naming the
/// folder when it, or one below it, cannot be read.
std::vector<std::string> FilesBelow(const std::string& path);

// File extensions.

/// ".jpg" of "Photo.JPG"; empty if the name has none.
inline std::string LowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace bodyloom
