// SPDX-License-Identifier: Apache-2.0
/// One clip of a batch: its request, the hash of everything its result depends on, its results in a folder, and its
/// record.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/batch/manifest.h"
#include "pipelines/track/track_people_clip.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

struct BatchClip {
  std::string id;
  ClipSettings settings;  ///< those of the request; part of the hash
  /// Request of `track` or of `run`. Outputs are those of TrackBatchClip(), selected by the two fields below.
  std::variant<TrackRequest, TrackPeopleClipRequest> request;
  bool overlay = false, report = false;
};

/// In the order of the table.
enum class ClipStatus { kFailed, kNoPersonFound, kDone, kSkipped };
constexpr const char* kClipStatusNames[] = {"failed", "nothing_to_track", "done", "skipped"};

struct ClipRecord {
  std::string id, verb;
  ClipStatus status = ClipStatus::kFailed;
  std::string reason;  ///< of kFailed and kNoPersonFound; one line
  std::string hash;    ///< ClipHash(); empty for kFailed
  double seconds = 0;  ///< wall clock of the tracking
  int frames = 0, people = 0;
  std::map<std::string, int> frames_by_status;  ///< sums over people
  /// Reprojection error of the 2D joints, pixels; maximum over people, NaN when nobody was tracked.
  double reprojection_median_px = std::numeric_limits<double>::quiet_NaN();
  double reprojection_p95_px = std::numeric_limits<double>::quiet_NaN();
};

/// "track" or "run".
std::string VerbOf(const BatchClip& clip);

/// SHA-256 in 64 hexadecimal digits of `version`, the verb, the settings, and the contents of every file they name (of
/// all files of a folder). Of a path only the file name counts, as some formats are recognised by it. The number of
/// threads is left out, since results do not depend on it. Throws std::runtime_error naming a file that cannot be read.
std::string ClipHash(const BatchClip& clip, const std::string& version);

/// Tracks the clip with the number of threads in its request and writes into the existing empty `folder`: everything
/// that `run` writes, or track.npz and report.json of `track`; on request overlay.mp4 and report.html. Reports name
/// files without their folder. Hash and seconds of the record are not set. If nobody can be tracked, the record has
/// that status and no file is left. Otherwise throws as TrackClip() and TrackPeopleClip() do.
ClipRecord TrackBatchClip(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks = {});

/// The record as a JSON object in one line without a newline. The keys are listed in docs/batch.md.
std::string ToLine(const ClipRecord& record);

/// Inverse of ToLine(). Throws std::runtime_error "path: place: what was found, expected what".
ClipRecord ClipRecordFromText(const std::string& text, const std::string& path);

/// CSV table (RFC 4180), one row per clip: failed, then nothing to track, then tracked clips by descending 95th
/// percentile of the reprojection error; ties by id. Unknown errors are empty.
std::string ToCsv(std::vector<ClipRecord> records);

}  // namespace bodyloom
