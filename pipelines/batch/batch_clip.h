// SPDX-License-Identifier: Apache-2.0
/// A clip of a batch: its request, what its result depends on, its results in a folder, and the record of how it ended.
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
  ClipSettings settings;  ///< those of the request, with which its hash is made
  /// Of `track` or of `run`. Outputs are those of TrackBatchClip(); the following two say which.
  std::variant<TrackRequest, TrackPeopleClipRequest> request;
  bool overlay = false, report = false;
};

/// In the order of the table.
enum class ClipStatus { kFailed, kNothingToTrack, kDone, kSkipped };
constexpr const char* kClipStatusNames[] = {"failed", "nothing_to_track", "done", "skipped"};

struct ClipRecord {
  std::string id, verb;
  ClipStatus status = ClipStatus::kFailed;
  std::string reason;  ///< of what failed, and of nothing to track; one line
  std::string hash;    ///< ClipHash(); empty of what failed
  double seconds = 0;  ///< wall clock of the tracking
  int frames = 0, people = 0;
  std::map<std::string, int> frames_by_status;  ///< sums over people
  /// Of the 2D joints, pixels: the largest of the people's; NaN when nobody was tracked.
  double reprojection_median_px = std::numeric_limits<double>::quiet_NaN();
  double reprojection_p95_px = std::numeric_limits<double>::quiet_NaN();
};

/// "track" or "run".
std::string VerbOf(const BatchClip& clip);

/// 64 hexadecimal digits (SHA-256) that are the same when and only when these are: `version`, the verb, the settings,
/// and the contents of every file that one of them names (of all files of a folder). Of a path its last name counts, by
/// which some formats are told apart, and not where it lies. The number of threads does not count: results do not
/// depend on it. Throws std::runtime_error naming a file that cannot be read.
std::string ClipHash(const BatchClip& clip, const std::string& version);

/// Tracks the clip, with as many threads as its request says, and writes into `folder`, which is there and empty: all
/// that `run` writes, or track.npz and report.json of `track`; on request overlay.mp4 and report.html. Reports name
/// files without their folder. The record lacks hash and seconds. Where nobody can be tracked, that is its status, and
/// no file is left. Throws as TrackClip() and TrackPeopleClip() do otherwise.
ClipRecord TrackBatchClip(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks = {});

/// The record as a JSON object in one line, without its end. The keys are listed in docs/batch.md.
std::string ToLine(const ClipRecord& record);

/// Its inverse. Throws std::runtime_error "path: place: what was found, expected what".
ClipRecord ClipRecordFromText(const std::string& text, const std::string& path);

/// A table (RFC 4180), a row a clip: failed, nothing to track, then the tracked by the 95th percentile of their
/// reprojection error from the largest; then by id. Errors that are not known are empty.
std::string ToCsv(std::vector<ClipRecord> records);

}  // namespace bodyloom
