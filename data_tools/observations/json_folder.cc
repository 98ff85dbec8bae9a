// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/json_folder.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/frame_numbers.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr JsonLimits kFrameLimits = {.max_bytes = size_t{64} << 20, .nan_is_null = true};

template <typename IsWanted>
std::vector<std::string> SortedNames(const std::string& folder, const IsWanted& is_wanted) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string name = it->path().filename().string();
    if (!name.starts_with('.') && is_wanted(*it)) names.push_back(std::move(name));
  }
  if (error) ThrowFileError(folder, "cannot list the folder: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

/// Parses a frame's file; false, with the reason, if it holds no whole JSON.
bool ParseFrame(const std::string& path, nlohmann::json* document, std::string* why) {
  const std::string bytes = ReadFileBytes(path, kFrameLimits.max_bytes);
  try {
    *document = ParseJson(bytes, path, kFrameLimits);
    return true;
  } catch (const std::runtime_error& error) {
    *why = bytes.empty() ? path + ": the file is empty" : error.what();
    return false;
  }
}

}  // namespace

std::vector<std::string> JsonFilesOf(const std::string& folder) {
  return SortedNames(folder, [](const fs::directory_entry& entry) { return entry.path().extension() == ".json"; });
}

std::vector<std::string> FoldersOf(const std::string& folder) {
  return SortedNames(folder, [](const fs::directory_entry& entry) {
    std::error_code ignored;
    return entry.is_directory(ignored);
  });
}

void ReadFirstFrame(const std::string& folder, const std::vector<std::string>& names,
                    const std::function<void(const JsonNode& document)>& take) {
  for (const std::string& name : names) {
    const std::string path = (fs::path(folder) / name).string();
    nlohmann::json document;
    std::string why;
    if (!ParseFrame(path, &document, &why) || document.empty()) continue;
    take(JsonNode(document, path));
    return;
  }
}

void ReadJsonFrames(const std::string& folder, const std::vector<std::string>& names,
                    const std::function<void(size_t index, const JsonNode& document)>& take,
                    std::vector<std::string>* warnings) {
  size_t broken = 0;
  std::string first_broken, first_reason;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string path = (fs::path(folder) / names[i]).string();
    nlohmann::json document;
    std::string why;
    if (ParseFrame(path, &document, &why)) {
      take(i, JsonNode(document, path));
    } else if (++broken == 1) {
      first_broken = names[i];
      first_reason = why;
    }
    // More than half of all: the rest needs no reading.
    if (2 * broken > names.size()) {
      throw std::runtime_error(Concatenate(first_reason, "; more than half of the folder's ", names.size(),
                                           " files are empty, cut or no JSON"));
    }
  }
  if (broken > 0 && warnings != nullptr) {
    warnings->push_back(Concatenate(folder, ": ", broken, " of ", names.size(),
                                    " files are empty, cut or no JSON and count as frames without detections, the "
                                    "first ",
                                    first_broken));
  }
}

PeopleSequence ReadPeopleFrames(const std::string& folder, const std::vector<std::string>& names, double fps,
                                const PeopleOfJson& people_of, std::vector<std::string>* warnings) {
  const KeypointConvention* convention = nullptr;
  std::vector<std::vector<DetectedPerson>> frames(names.size());
  ReadJsonFrames(
      folder, names, [&](size_t i, const JsonNode& document) { frames[i] = people_of(document, &convention); },
      warnings);
  return PeopleOnGrid(std::move(frames), NumbersOrOrder(names), convention, fps, folder);
}

}  // namespace bodyloom
