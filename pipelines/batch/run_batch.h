// SPDX-License-Identifier: Apache-2.0
/// Many clips tracked, each once, however often a run is killed and started again.
///
///   OUT/clips/ID/         a clip's results and clip.json, its record: all of it or no folder
///   OUT/failed/ID.json    the record of a clip that failed, until it is done
///   OUT/clips.csv         the table (ToCsv()) of all clips, written by each run after which none is missing
///   OUT/.work/            what is being written
///
/// A clip is done when its record has the hash (ClipHash()) of this run, also one in which there was nothing to track.
/// One that failed is tried again. Runs share nothing but the folder; of two that have the same clip (which ShardOf()
/// avoids) both may track it, and the results that come first stay.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/batch/batch_clip.h"

namespace bodyloom {

struct RunBatchRequest {
  std::vector<BatchClip> clips;                     ///< to be done here: those of a shard
  std::vector<std::string> ids_of_table;            ///< of the clips of all shards
  std::string out;                                  ///< made when it is not there
  int jobs = 1;                                     ///< clips at once; each takes as many threads as its request says
  std::function<void(const ClipRecord&)> on_ended;  ///< called for each clip, by one thread at a time
};

struct RunBatchReport {
  std::map<ClipStatus, int> clips;  ///< how many ended so
  std::string table;                ///< the file; empty when clips of other shards are missing
};

/// How many clips ended how, and the table, in one line without its end.
std::string ToText(const RunBatchReport& report);

/// Tracks what is not done. A clip that fails stops no other. Results are the same bytes for any number of jobs and
/// shards, but for times and memory in the reports. Throws Cancelled and DiskFullError: what was being written is
/// removed then, and what is done stays; std::runtime_error when `out` cannot be written.
RunBatchReport RunBatch(const RunBatchRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
