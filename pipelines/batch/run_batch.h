// SPDX-License-Identifier: Apache-2.0
/// Tracks many clips, each once, and resumes after interruption.
///
///   OUT/clips/ID/         a clip's results and clip.json, its record: all of it or no folder
///   OUT/failed/ID.json    the record of a clip that failed, until it is done
///   OUT/clips.csv         the table (ToCsv()) of all clips, written by each run after which none is missing
///   OUT/.work/            what is being written
///
/// A clip is done when its record has this run's hash (ClipHash()); this includes clips with nobody to track. Failed
/// clips are tried again. Runs share nothing but the folder; if two runs have the same clip (which ShardOf() avoids),
/// both may track it and the first results are kept.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/batch/batch_clip.h"

namespace bodyloom {

struct RunBatchRequest {
  std::vector<BatchClip> clips;                     ///< clips of this shard
  std::vector<std::string> ids_of_table;            ///< ids of the clips of all shards
  std::string out;                                  ///< made when it is not there
  int jobs = 1;                                     ///< clips at once; each takes as many threads as its request says
  std::function<void(const ClipRecord&)> on_ended;  ///< called for each clip, by one thread at a time
};

struct RunBatchReport {
  std::map<ClipStatus, int> clips;  ///< number by status
  std::string table;                ///< the file; empty when clips of other shards are missing
};

/// Number of clips by status, and the path of the table, in one line without a newline.
std::string ToText(const RunBatchReport& report);

/// Tracks the clips that are not done. A failing clip does not stop the others. Results are identical bytes for any
/// number of jobs and shards, except times and memory in the reports. Throws Cancelled and DiskFullError (unfinished
/// clips are removed, finished ones kept), and std::runtime_error when `out` cannot be written.
RunBatchReport RunBatch(const RunBatchRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
