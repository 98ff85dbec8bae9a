// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/model_files.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace bodyloom {
namespace fs = std::filesystem;

std::vector<std::string> ModelFolders(const std::string& folder, const std::string& variable,
                                      const std::string& program, const std::string& module) {
  if (!folder.empty()) return {folder};
  if (!variable.empty()) return {variable};
  const fs::path home = fs::path(program).parent_path();
  std::vector<std::string> folders = {(home / ".." / "share" / "bodyloom" / "models").lexically_normal().string()};
  std::error_code ignored;
  if (fs::exists(home / ".." / "CMakeCache.txt", ignored)) {
    folders.push_back((home / ".." / ".." / "models").lexically_normal().string());
  }
  if (!module.empty()) folders.push_back((fs::path(module).parent_path() / "models").string());
  return folders;
}

namespace {

/// Path of the shared library that holds this function; empty in a program.
std::string SharedLibraryOfThisCode(const fs::path& program) {
  Dl_info found{};
  std::error_code ignored;
  const void* here = reinterpret_cast<const void*>(&FindModelFile);
  if (dladdr(here, &found) == 0 || found.dli_fname == nullptr || fs::equivalent(found.dli_fname, program, ignored)) {
    return "";
  }
  return found.dli_fname;
}

}  // namespace

std::string FindModelFile(const std::string& file, const std::string& folder) {
  const char* variable = std::getenv("BODYLOOM_MODELS");
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  std::string looked;
  for (const std::string& place :
       ModelFolders(folder, variable == nullptr ? "" : variable, program.string(), SharedLibraryOfThisCode(program))) {
    const fs::path path = fs::path(place) / file;
    if (fs::is_regular_file(path, ignored)) return path.string();
    looked += (looked.empty() ? "" : ", ") + place;
  }
  throw std::runtime_error(
      file + ": not in " + looked +
      "; expected a network of the pose detector there: `./dev models` fetches it, --models DIR or "
      "BODYLOOM_MODELS names another folder");
}

}  // namespace bodyloom
