// SPDX-License-Identifier: Apache-2.0
/// How a clip of a batch ended: the line that is told of it, and the record that its folder of results keeps.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

namespace bodyloom {

enum class ClipStatus {
  kDone,            ///< tracked by this process
  kSkipped,         ///< tracked before from the same inputs with the same options by the same version
  kNothingToTrack,  ///< nobody is in it, or nothing could be estimated
  kFailed,          ///< an input cannot be used, or the options contradict it
  kRetry,           ///< not finished and not the clip's fault: interrupted, out of room, or at work elsewhere
};

/// "done", "skipped", "nothing_to_track", "failed", "retry".
std::string ToString(ClipStatus status);

/// A file of results: what tells that it is the one that was written.
struct ResultFile {
  uint64_t bytes = 0;
  std::string sha256;
};

struct ClipRecord {
  std::string id, verb;
  ClipStatus status = ClipStatus::kFailed;
  std::string reason;  ///< of everything but done and skipped; one line
  std::string hash;    ///< ClipHash(); empty when the inputs could not be read
  std::string version;
  double seconds = 0;  ///< wall clock, of the process that told or wrote this
  int frames = 0, people = 0;
  std::map<std::string, int> frames_by_status;  ///< sums over people
  /// Of the 2D joints, pixels: the largest of the people's; NaN when nobody was tracked.
  double reprojection_median_px = std::numeric_limits<double>::quiet_NaN();
  double reprojection_p95_px = std::numeric_limits<double>::quiet_NaN();
  std::map<std::string, ResultFile> files;  ///< of the clip's folder, by name; without the record itself
};

/// What is told of a clip: a JSON object in one line, without its end. The keys are listed in docs/batch.md.
std::string ToLine(const ClipRecord& record);

/// The record as a file: the line's keys, and version, hash and files.
std::string ToJson(const ClipRecord& record);

/// Its inverse. Throws std::runtime_error "path: place: what was found, expected what".
ClipRecord ClipRecordFromText(const std::string& text, const std::string& path);

/// The name of the record in a clip's folder.
inline constexpr const char* kClipRecordFile = "clip.json";

/// Every file of the folder but the record.
std::map<std::string, ResultFile> ResultFilesOf(const std::string& folder);

/// The record of a folder of results that is whole: it can be read, is that of `id`, and every file that it names is there
/// with the same contents. Nothing otherwise.
std::optional<ClipRecord> ReadWholeClip(const std::string& folder, const std::string& id);

}  // namespace bodyloom
