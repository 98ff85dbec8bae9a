// SPDX-License-Identifier: Apache-2.0
/// The results of a batch as one table and one page, the clips that need a look first.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/pipelines/batch/clip_record.h"

namespace bodyloom {

/// What the results hold of a clip of the manifest.
struct MergedClip {
  std::string id;
  bool is_missing = false;  ///< no record of it is there (any more): not tracked yet, or what is there cannot be read
  ClipRecord record;        ///< done, nothing to track or failed; when missing, the reason alone
  std::string link;         ///< to the clip's own page, else its report, else nothing; relative to the results
};

struct MergeResultsRequest {
  std::string out;       ///< the folder of a batch's results
  std::string manifest;  ///< empty: the one of the latest run, which lies there
};

struct MergeResultsReport {
  std::vector<MergedClip> clips;  ///< in the order of the page
  int unlisted = 0;               ///< folders of clips that are not in the manifest, and are left out
  std::vector<std::string> outputs;

  [[nodiscard]] int Count(ClipStatus status) const;  ///< of those that are not missing
  [[nodiscard]] int CountMissing() const;
};

/// How many clips are what, which are missing, and the files written: a few lines, the last one with a newline.
std::string ToText(const MergeResultsReport& report);

/// The order of the page: failed; missing; nothing to track; then the tracked, by the 95th percentile of their
/// reprojection error from the largest; then by id.
void SortWorstFirst(std::vector<MergedClip>* clips);

/// A line a clip, after one with the names of the columns (RFC 4180). What is not known is empty.
std::string ToCsv(const std::vector<MergedClip>& clips);
/// ToLine() of each clip, with "missing" for a status.
std::string ToLines(const std::vector<MergedClip>& clips);
/// One HTML file that fetches nothing; ids link to the clips' own pages.
std::string ToHtml(const MergeResultsReport& report);

/// Reads the records of the manifest's clips and writes clips.csv, clips.jsonl and index.html into `out`, each whole or
/// not at all. A record that cannot be read is told of as missing, with the reason. Only the records are read: whether the
/// files beside them are as they were is looked at by RunBatch(). Throws std::runtime_error for a folder or manifest that
/// cannot be used, PlaceTaken when another process is merging, DiskFullError.
MergeResultsReport MergeResults(const MergeResultsRequest& request);

}  // namespace bodyloom
