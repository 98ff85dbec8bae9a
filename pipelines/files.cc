// SPDX-License-Identifier: Apache-2.0
#include "pipelines/files.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/callbacks.h"

namespace bodyloom {
namespace fs = std::filesystem;

void RequireReadable(const std::string& path, const std::string& what) {
  if (!path.empty() && access(path.c_str(), R_OK) != 0) {
    throw std::runtime_error(path + ": " + std::strerror(errno) + ", expected a readable file (" + what + ")");
  }
}

void RequireReadableBody(const std::string& body) {
  if (body != kBodyWithHands) RequireReadable(body, "body model");
}

void RequireWritable(const std::string& path) {
  if (path.empty()) {
    return;
  }
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {  // replacing /dev/null would be a pity
    throw std::runtime_error(path + ": is a folder or device, expected the name of a file to write");
  }
  // The real thing, small: a folder on a full disk or under a read-only mount says so only when written to.
  const std::string probe = path + ".probe" + std::to_string(getpid());
  try {
    WriteFileAtomically(probe, "probe");
  } catch (const DiskFullError& error) {
    throw DiskFullError(path + ": cannot be written (" + error.what() + ")");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": cannot be written (" + error.what() + ")");
  }
  fs::remove(probe, ignored);
}

void RequireWritableFolder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!fs::is_directory(path)) {
    throw std::runtime_error(path + ": cannot be made a folder" + (error ? " (" + error.message() + ")" : ""));
  }
  RequireWritable((fs::path(path) / "file").string());
}

void RequireDistinct(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
  const auto resolved = [](const std::string& path) { return fs::weakly_canonical(fs::absolute(path)); };
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty()) {
      continue;
    }
    for (const std::string& input : inputs) {
      if (!input.empty() && resolved(input) == resolved(outputs[i])) {
        throw RequestError(outputs[i] + " is given both to read and to write");
      }
    }
    for (size_t j = 0; j < i; ++j) {
      if (!outputs[j].empty() && resolved(outputs[j]) == resolved(outputs[i])) {
        throw RequestError(outputs[i] + " is given twice to write");
      }
    }
  }
}

size_t PeakMemoryBytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<size_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
}

void ReturnFreedMemory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace bodyloom
