// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <utility>

namespace bodyloom {
namespace {

/// Different for each call: processes on two machines may have the same number and write into one folder.
std::string TemporaryBeside(const std::string& target) {
  const std::filesystem::path path(target);
  std::random_device random;
  const std::string name = "." + path.stem().string() + ".tmp" + std::to_string(::getpid()) + "-" +
                           std::to_string(random()) + path.extension().string();
  return (path.parent_path() / name).string();
}

void SyncFolderOf(const std::string& path) {
  std::string folder = std::filesystem::path(path).parent_path().string();
  if (folder.empty()) folder = ".";
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (fd < 0) return;  // not every file system lets a folder be opened; the rename itself has succeeded
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

void ThrowSystemError(const std::string& path, const std::string& action) {
  const int reason = errno;
  const std::string message = path + ": cannot " + action + ": " + std::strerror(reason);
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG) throw DiskFullError(message);
  throw std::runtime_error(message);
}

std::string ReadFileBytes(const std::string& path, size_t max_bytes) {
  // Without O_NONBLOCK, opening a pipe without a writer would block forever.
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) ThrowSystemError(path, "open for reading");
  struct stat info {};
  if (::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
    ::close(fd);
    throw std::runtime_error(path + ": not a regular file");
  }
  if (static_cast<size_t>(info.st_size) > max_bytes) {
    ::close(fd);
    throw std::runtime_error(path + ": " + std::to_string(info.st_size) + " bytes, at most " +
                             std::to_string(max_bytes) + " are read");
  }
  std::string bytes(static_cast<size_t>(info.st_size), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::read(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      ::close(fd);
      ThrowSystemError(path, "read");
    }
    if (n == 0) break;
    done += static_cast<size_t>(n);
  }
  ::close(fd);
  bytes.resize(done);
  return bytes;
}

void WriteFileAtomically(const std::string& path, const std::string& bytes) {
  AtomicPath file(path);
  const int fd = ::open(file.temporary().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) ThrowSystemError(path, "open for writing");
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int reason = errno;
      ::close(fd);
      errno = reason;
      ThrowSystemError(path,
                       "write (" + std::to_string(done) + " of " + std::to_string(bytes.size()) + " bytes written)");
    }
    done += static_cast<size_t>(n);
  }
  if (::close(fd) != 0) ThrowSystemError(path, "close");
  file.Commit();
}

AtomicPath::AtomicPath(std::string target) : target_(std::move(target)), temporary_(TemporaryBeside(target_)) {}

AtomicPath::~AtomicPath() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicPath::Commit() {
  const int fd = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) ThrowSystemError(target_, "finish (no output was written)");
  const bool synced = ::fsync(fd) == 0;
  ::close(fd);
  if (!synced) ThrowSystemError(target_, "flush to disk");
  if (::rename(temporary_.c_str(), target_.c_str()) != 0)
    ThrowSystemError(target_, "move the finished file into place");
  committed_ = true;
  SyncFolderOf(target_);
}

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
