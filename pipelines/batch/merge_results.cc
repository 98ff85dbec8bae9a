// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/merge_results.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <tuple>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/printable.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/batch/manifest.h"
#include "bodyloom/pipelines/batch/run_batch.h"
#include "bodyloom/pipelines/batch/work_place.h"
#include "bodyloom/pipelines/fixed_text.h"
#include "bodyloom/pipelines/page/report_page.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// Of the folder's work places, none that a clip can have.
constexpr const char* kMergePlace = ".merge";
constexpr const char *kTableFile = "clips.csv", *kLinesFile = "clips.jsonl", *kIndexFile = "index.html";

std::string StatusText(const MergedClip& clip) { return clip.is_missing ? "missing" : ToString(clip.record.status); }

int Rank(const MergedClip& clip) {
  if (clip.is_missing) return 1;
  switch (clip.record.status) {
    case ClipStatus::kFailed:
    case ClipStatus::kRetry:
      return 0;
    case ClipStatus::kNothingToTrack:
      return 2;
    case ClipStatus::kDone:
    case ClipStatus::kSkipped:
      break;
  }
  return 3;
}

int FramesOf(const MergedClip& clip, const char* status) {
  const auto found = clip.record.frames_by_status.find(status);
  return found == clip.record.frames_by_status.end() ? 0 : found->second;
}

std::string FixedOrEmpty(double value, int digits) { return std::isfinite(value) ? Fixed(value, digits) : ""; }

/// The cells of a clip after its id, as text: the columns of kMergedColumns.
std::vector<std::string> CellsOf(const MergedClip& clip) {
  const ClipRecord& record = clip.record;
  const bool tracked = Rank(clip) == 3;
  const auto count = [&](int n) { return tracked ? std::to_string(n) : std::string(); };
  return {StatusText(clip),
          FixedOrEmpty(record.reprojection_p95_px, 2),
          FixedOrEmpty(record.reprojection_median_px, 2),
          count(record.frames),
          count(record.people),
          count(FramesOf(clip, "weak")),
          count(FramesOf(clip, "interpolated")),
          count(FramesOf(clip, "lost")),
          tracked ? Fixed(record.seconds, 2) : "",
          record.reason};
}

constexpr std::array kMergedColumns = {"status",
                                       "reprojection_p95_px",
                                       "reprojection_median_px",
                                       "frames",
                                       "people",
                                       "weak",
                                       "interpolated",
                                       "lost",
                                       "seconds",
                                       "reason"};
constexpr std::array kMergedHeads = {"clip",   "status", "error, 95 % below (px)", "median (px)", "frames",
                                     "people", "weak",   "interpolated",           "lost",        "seconds",
                                     "reason"};

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + "\"";
}

MergedClip ReadMerged(const std::string& out, const std::string& id) {
  MergedClip clip;
  clip.id = id;
  clip.record.id = id;
  const fs::path folder = ClipFolder(out, id), failure = FailureFile(out, id);
  const bool failed = fs::exists(failure);
  const fs::path path = failed ? failure : folder / kClipRecordFile;
  try {
    if (!fs::exists(path)) throw std::runtime_error("no results");
    ClipRecord record = ClipRecordFromText(ReadFileBytes(path.string()), path.string());
    if (record.id != id) throw std::runtime_error(path.string() + ": the record of another clip");
    clip.record = std::move(record);
  } catch (const std::runtime_error& error) {
    clip.is_missing = true;
    clip.record.reason = error.what();
    return clip;
  }
  if (failed) return clip;
  for (const char* name : {"report.html", "report.json"}) {
    if (clip.link.empty() && fs::exists(folder / name)) clip.link = "clips/" + id + "/" + name;
  }
  return clip;
}

int CountUnlisted(const std::string& out, const std::vector<ManifestClip>& listed) {
  std::set<std::string> ids;
  for (const ManifestClip& clip : listed) ids.insert(clip.id);
  int unlisted = 0;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(out) / "clips", ignored)) {
    unlisted += ids.contains(entry.path().filename().string()) ? 0 : 1;
  }
  return unlisted;
}

}  // namespace

int MergeResultsReport::Count(ClipStatus status) const {
  return static_cast<int>(std::count_if(clips.begin(), clips.end(), [&](const MergedClip& clip) {
    return !clip.is_missing && clip.record.status == status;
  }));
}

int MergeResultsReport::CountMissing() const {
  return static_cast<int>(
      std::count_if(clips.begin(), clips.end(), [](const MergedClip& clip) { return clip.is_missing; }));
}

std::string ToText(const MergeResultsReport& report) {
  std::vector<std::string> missing;
  for (const MergedClip& clip : report.clips) {
    if (clip.is_missing) missing.push_back(clip.id);
  }
  std::string text = Concatenate(report.clips.size(),
                                 report.clips.size() == 1 ? " clip: " : " clips: ", report.Count(ClipStatus::kDone),
                                 " done, ", report.Count(ClipStatus::kNothingToTrack), " with nothing to track, ",
                                 report.Count(ClipStatus::kFailed), " failed, ", missing.size(), " missing\n");
  if (!missing.empty()) text += "missing  " + PrintableList(missing) + "\n";
  for (const std::string& output : report.outputs) text += "wrote    " + output + "\n";
  return text;
}

void SortWorstFirst(std::vector<MergedClip>* clips) {
  const auto key = [](const MergedClip& clip) {
    const double error = clip.record.reprojection_p95_px;
    return std::tuple(Rank(clip), std::isfinite(error) ? -error : 0.0, clip.id);
  };
  std::sort(clips->begin(), clips->end(), [&](const MergedClip& a, const MergedClip& b) { return key(a) < key(b); });
}

std::string ToCsv(const std::vector<MergedClip>& clips) {
  std::string text = "id";
  for (const char* column : kMergedColumns) text += std::string(",") + column;
  text += "\n";
  for (const MergedClip& clip : clips) {
    text += clip.id;
    for (const std::string& cell : CellsOf(clip)) text += "," + CsvField(cell);
    text += "\n";
  }
  return text;
}

std::string ToLines(const std::vector<MergedClip>& clips) {
  std::string text;
  for (const MergedClip& clip : clips) {
    nlohmann::ordered_json line = nlohmann::ordered_json::parse(ToLine(clip.record));
    line["status"] = StatusText(clip);
    text += line.dump() + "\n";
  }
  return text;
}

std::string ToHtml(const MergeResultsReport& report) {
  const auto number = [](int n) { return std::to_string(n); };
  ReportPage page("Clips",
                  "The clips that need a look first: failed, missing, empty, then the tracked by their error.");
  page.AddFigures({{number(static_cast<int>(report.clips.size())), "clips in the manifest"},
                   {number(report.Count(ClipStatus::kDone)), "tracked"},
                   {number(report.Count(ClipStatus::kFailed)), "failed"},
                   {number(report.CountMissing()), "missing"},
                   {number(report.Count(ClipStatus::kNothingToTrack)), "with nothing to track"}});
  std::string table = "<table>\n<tr>";
  for (const char* head : kMergedHeads) table += "<th>" + EscapeHtml(head) + "</th>";
  table += "</tr>\n";
  for (const MergedClip& clip : report.clips) {
    const std::string id = EscapeHtml(clip.id);
    table +=
        "<tr><td>" + (clip.link.empty() ? id : "<a href=\"" + EscapeHtml(clip.link) + "\">" + id + "</a>") + "</td>";
    const std::vector<std::string> cells = CellsOf(clip);
    for (size_t i = 0; i < cells.size(); ++i) {
      const bool is_number = i > 0 && i + 1 < cells.size();
      table += (is_number ? "<td class=\"n\">" : "<td>") + EscapeHtml(cells[i]) + "</td>";
    }
    table += "</tr>\n";
  }
  page.AddHtml(table + "</table>\n");
  if (report.unlisted > 0) {
    page.AddParagraph(number(report.unlisted) + " more among the results are not in the manifest and are left out.");
  }
  page.AddParagraph(
      "Errors are of the 2D joints, in pixels of the clip, the largest of the people's. The same table is in "
      "clips.csv, "
      "and with all that is known of a clip in clips.jsonl.");
  return page.ToHtml();
}

MergeResultsReport MergeResults(const MergeResultsRequest& request) {
  const std::string kept = BatchManifestFile(request.out);
  if (!fs::is_directory(request.out))
    throw std::runtime_error(request.out + ": no such folder, expected that of a batch's results");
  if (request.manifest.empty() && !fs::exists(kept)) {
    throw std::runtime_error(kept + ": not there, expected the folder of a batch's results (or --manifest FILE)");
  }
  const std::vector<ManifestClip> listed = ReadManifest(request.manifest.empty() ? kept : request.manifest);
  MergeResultsReport report;
  for (const ManifestClip& clip : listed) report.clips.push_back(ReadMerged(request.out, clip.id));
  SortWorstFirst(&report.clips);
  report.unlisted = CountUnlisted(request.out, listed);
  WorkPlace place(BatchWorkFolder(request.out), kMergePlace);
  const auto write = [&](const char* name, const std::string& text) {
    WriteFileAtomically(place.folder() + "/" + name, text);
    report.outputs.push_back((fs::path(request.out) / name).string());
    place.MoveFileTo(name, report.outputs.back());
  };
  write(kTableFile, ToCsv(report.clips));
  write(kLinesFile, ToLines(report.clips));
  write(kIndexFile, ToHtml(report));
  return report;
}

}  // namespace bodyloom
