// SPDX-License-Identifier: Apache-2.0
/// Many clips tracked, each once, whoever else is at them and however often a process is killed.
///
///   OUT/clips/ID/           results of a clip; the folder is there when they are whole, with clip.json (clip_record.h)
///   OUT/failures/ID.json    the record of a clip that failed, until it is tracked
///   OUT/manifest.jsonl      the manifest of the latest run, for MergeResults()
///   OUT/.work/              where clips are at work (work_place.h); gone when none is
///
/// A clip whose folder is whole and has the hash (ClipHash()) of this run is left as it is, also one in which there was
/// nothing to track. One that failed is tried again: what was wrong may have been put right.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bodyloom/pipelines/batch/batch_clip.h"
#include "bodyloom/pipelines/batch/clip_record.h"

namespace bodyloom {

struct RunBatchRequest {
  std::vector<BatchClip> clips;  ///< to be done here: those of a shard
  std::string manifest;          ///< the text of the whole manifest; empty: none is kept
  std::string out;
  int jobs = 1;  ///< clips at once; each takes as many threads as its request says
};

/// The stage of a clip that is about to begin.
inline constexpr const char* kBatchStageBegin = "begin";

/// Where a batch is.
struct BatchProgress {
  std::string clip, stage;  ///< the clip that went on, and its stage
  double fraction = 0;      ///< of that clip, in [0, 1]
  int ended = 0, all = 0;   ///< clips
  double whole = 0;         ///< of the batch, in [0, 1]: clips that ended, and the parts of those at work
};

/// Called by one thread at a time.
struct BatchCallbacks {
  std::function<void(const ClipRecord&)> ended;          ///< once for each clip of the request
  std::function<bool(const BatchProgress&)> progress;    ///< false: leave what is at work, and begin nothing more
  std::function<void(const std::string& line)> message;  ///< "ID: …": what a user should know of a clip besides
};

struct RunBatchReport {
  std::map<ClipStatus, int> clips;  ///< how many ended so
  double seconds = 0;

  [[nodiscard]] int Count(ClipStatus status) const;
};

/// How many clips ended how, in one line without its end.
std::string ToText(const RunBatchReport& report);

/// Tracks what is not there yet. A clip that fails stops no other; an interruption or a full disk stops all, and those not
/// finished end as kRetry. A clip at which another process is comes last, and ends as kRetry when it still is. Results are
/// the same bytes for any number of jobs and shards, but for times and memory in the reports. Throws std::invalid_argument
/// for jobs outside 1 to 256, and std::runtime_error when `out` cannot be written (DiskFullError when it is full).
RunBatchReport RunBatch(const RunBatchRequest& request, const BatchCallbacks& callbacks = {});

/// Folder, or file, of these in a batch's results.
std::string ClipFolder(const std::string& out, const std::string& id);
std::string FailureFile(const std::string& out, const std::string& id);
std::string BatchManifestFile(const std::string& out);
std::string BatchWorkFolder(const std::string& out);

}  // namespace bodyloom
