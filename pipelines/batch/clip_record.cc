// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/clip_record.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/files_below.h"
#include "bodyloom/data_tools/formats/json_reader.h"
#include "bodyloom/data_tools/formats/printable.h"
#include "bodyloom/data_tools/formats/sha256.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr size_t kMostRecordBytes = size_t{16} << 20;
constexpr std::array kStatusNames = {std::pair(ClipStatus::kDone, "done"), std::pair(ClipStatus::kSkipped, "skipped"),
                                     std::pair(ClipStatus::kNothingToTrack, "nothing_to_track"),
                                     std::pair(ClipStatus::kFailed, "failed"), std::pair(ClipStatus::kRetry, "retry")};

ClipStatus StatusFrom(const JsonNode& node) {
  const std::string name = node.Text();
  for (const auto& [status, known] : kStatusNames) {
    if (name == known) return status;
  }
  Refuse(node.place(), "'" + PrintableText(name) + "', expected the status of a clip");
}

std::string OneLineText(const JsonNode& node) {
  std::string text = node.Text();
  if (!IsOneLine(text)) Refuse(node.place(), "expected a text in one line");
  return text;
}

int Count(const JsonNode& node) {
  const int count = node.Int();
  if (count < 0) Refuse(node.place(), std::to_string(count) + ", expected a number that is not negative");
  return count;
}

double NumberOrNan(const JsonNode& node) {
  return node.is_null() ? std::numeric_limits<double>::quiet_NaN() : node.Number();
}

Json LineJson(const ClipRecord& record) {
  return {{"id", record.id},
          {"status", ToString(record.status)},
          {"reason", record.reason},
          {"verb", record.verb},
          {"seconds", std::round(1e3 * record.seconds) / 1e3},
          {"frames", record.frames},
          {"people", record.people},
          {"frames_by_status", record.frames_by_status},
          {"reprojection_median_px", record.reprojection_median_px},
          {"reprojection_p95_px", record.reprojection_p95_px}};
}

}  // namespace

std::string ToString(ClipStatus status) {
  for (const auto& [known, name] : kStatusNames) {
    if (status == known) return name;
  }
  throw std::invalid_argument("no such status of a clip");
}

std::string ToLine(const ClipRecord& record) {
  return LineJson(record).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string ToJson(const ClipRecord& record) {
  Json json = LineJson(record);
  json["version"] = record.version;
  json["hash"] = record.hash;
  json["files"] = Json::object();
  for (const auto& [name, file] : record.files) json["files"][name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ClipRecord ClipRecordFromText(const std::string& text, const std::string& path) {
  const nlohmann::json json = ParseJson(text, path, {.max_bytes = kMostRecordBytes, .max_depth = 4});
  const JsonNode node(json, path);
  ClipRecord record;
  record.id = OneLineText(node.At("id"));
  record.verb = OneLineText(node.At("verb"));
  record.status = StatusFrom(node.At("status"));
  record.reason = OneLineText(node.At("reason"));
  record.version = OneLineText(node.At("version"));
  record.hash = OneLineText(node.At("hash"));
  record.seconds = node.At("seconds").Number();
  record.frames = Count(node.At("frames"));
  record.people = Count(node.At("people"));
  const JsonNode counts = node.At("frames_by_status");
  for (const std::string& status : counts.Keys())
    record.frames_by_status[PrintableText(status)] = Count(counts.At(status));
  record.reprojection_median_px = NumberOrNan(node.At("reprojection_median_px"));
  record.reprojection_p95_px = NumberOrNan(node.At("reprojection_p95_px"));
  const JsonNode files = node.At("files");
  for (const std::string& name : files.Keys()) {
    const JsonNode file = files.At(name);
    if (name.empty() || name.find('/') != std::string::npos || !IsOneLine(name) || name == "." || name == "..") {
      Refuse(files.place(), "'" + PrintableText(name) + "', expected the name of a file in the folder");
    }
    const int64_t bytes = file.At("bytes").Integer();
    if (bytes < 0) Refuse(file.place(), "bytes", "expected a number that is not negative");
    record.files[name] = {static_cast<uint64_t>(bytes), OneLineText(file.At("sha256"))};
  }
  return record;
}

std::map<std::string, ResultFile> ResultFilesOf(const std::string& folder) {
  std::map<std::string, ResultFile> files;
  for (const std::string& path : FilesBelow(folder)) {
    const std::string name = fs::path(path).filename().string();
    if (name != kClipRecordFile) files[name] = {fs::file_size(path), Sha256OfFile(path)};
  }
  return files;
}

std::optional<ClipRecord> ReadWholeClip(const std::string& folder, const std::string& id) {
  const std::string path = (fs::path(folder) / kClipRecordFile).string();
  try {
    if (!fs::exists(path)) return std::nullopt;
    ClipRecord record = ClipRecordFromText(ReadFileBytes(path, kMostRecordBytes), path);
    if (record.id != id) return std::nullopt;
    for (const auto& [name, file] : record.files) {
      const std::string result = (fs::path(folder) / name).string();
      if (fs::file_size(result) != file.bytes || Sha256OfFile(result) != file.sha256) return std::nullopt;
    }
    return record;
  } catch (const std::runtime_error&) {  // garbage, or a file that is gone: not whole
    return std::nullopt;
  }
}

}  // namespace bodyloom
