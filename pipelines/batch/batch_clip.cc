// SPDX-License-Identifier: Apache-2.0
#include "pipelines/batch/batch_clip.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/sha256.h"
#include "geometry/base/check.h"
#include "geometry/scene/observations.h"
#include "pipelines/report_text.h"
#include "pipelines/track/track_clip.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string NameAlone(const std::string& path) { return fs::path(path).filename().string(); }

void AddCounts(const TrackSequenceSummary& solve, ClipRecord* record) {
  for (const auto& [status, frames] : solve.frames_by_status) record->frames_by_status[status] += frames;
  // fmax passes over NaN, which both are at first.
  record->reprojection_median_px = std::fmax(record->reprojection_median_px, solve.reprojection_median_px);
  record->reprojection_p95_px = std::fmax(record->reprojection_p95_px, solve.reprojection_p95_px);
  ++record->people;
}

void TrackOne(const BatchClip& clip, const fs::path& folder, const PipelineCallbacks& callbacks, ClipRecord* record) {
  TrackRequest request = std::get<TrackRequest>(clip.request);
  request.out = (folder / "track.npz").string();
  if (clip.overlay) request.overlay = (folder / "overlay.mp4").string();
  if (clip.report) request.report = (folder / "report.html").string();
  TrackReport report = TrackClip(request, callbacks);
  for (std::string& output : report.outputs) output = NameAlone(output);
  WriteFileAtomically((folder / "report.json").string(), ToJson(report));
  record->frames = report.num_frames;
  AddCounts(report.solve, record);
}

void TrackAll(const BatchClip& clip, const fs::path& folder, const PipelineCallbacks& callbacks, ClipRecord* record) {
  TrackPeopleClipRequest request = std::get<TrackPeopleClipRequest>(clip.request);
  request.out = folder.string();
  request.overlay = clip.overlay;
  request.report = clip.report;
  TrackPeopleReport report = TrackPeopleClip(request, callbacks);
  for (std::string& output : report.outputs) output = NameAlone(output);
  for (TrackedPerson& person : report.people) {
    person.track = NameAlone(person.track);
    if (person.solve.IsUsable()) AddCounts(person.solve, record);
  }
  WriteFileAtomically((folder / "summary.json").string(), ToJson(report));
  record->frames = report.num_frames;
}

ClipStatus StatusFrom(const JsonNode& node) {
  const std::string name = node.Text();
  for (size_t i = 0; i < std::size(kClipStatusNames); ++i) {
    if (name == kClipStatusNames[i]) return static_cast<ClipStatus>(i);
  }
  ThrowFileError(node.place(), "'" + PrintableText(name) + "', expected the status of a clip");
}

std::string CsvCell(double error) { return std::isfinite(error) ? Fixed(error, 2) : ""; }

}  // namespace

std::string VerbOf(const BatchClip& clip) {
  return std::holds_alternative<TrackRequest>(clip.request) ? "track" : "run";
}

std::string ClipHash(const BatchClip& clip, const std::string& version) {
  Sha256 sha;
  sha.AddField(version);
  sha.AddField(VerbOf(clip));
  for (const auto& [name, value] : clip.settings) {
    if (name == "threads") continue;
    const bool is_path = IsPathSetting(name, value);
    sha.AddField(name);
    sha.AddField(is_path ? NameAlone(fs::path(value).lexically_normal().string()) : value);
    if (is_path) sha.AddField(Sha256OfTree(value));
  }
  return sha.Hex();
}

ClipRecord TrackBatchClip(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks) {
  ClipRecord record;
  record.id = clip.id;
  record.verb = VerbOf(clip);
  record.status = ClipStatus::kDone;
  try {
    const auto track = record.verb == "track" ? TrackOne : TrackAll;
    track(clip, folder, callbacks, &record);
  } catch (const NoPersonFound& nothing) {
    for (const fs::directory_entry& left : fs::directory_iterator(folder)) fs::remove_all(left.path());
    record.status = ClipStatus::kNoPersonFound;
    record.reason = nothing.what();
  }
  return record;
}

std::string ToLine(const ClipRecord& record) {
  return ordered_json({{"id", record.id},
                       {"status", kClipStatusNames[static_cast<size_t>(record.status)]},
                       {"reason", record.reason},
                       {"verb", record.verb},
                       {"seconds", std::round(1e3 * record.seconds) / 1e3},
                       {"frames", record.frames},
                       {"people", record.people},
                       {"frames_by_status", record.frames_by_status},
                       {"reprojection_median_px", record.reprojection_median_px},
                       {"reprojection_p95_px", record.reprojection_p95_px},
                       {"hash", record.hash}})
      .dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

ClipRecord ClipRecordFromText(const std::string& text, const std::string& path) {
  const nlohmann::json json = ParseJson(text, path, {.max_bytes = size_t{1} << 20, .max_depth = 3});
  const JsonNode node(json, path);
  ClipRecord record;
  record.id = node.At("id").Text();
  record.verb = node.At("verb").Text();
  record.status = StatusFrom(node.At("status"));
  record.reason = node.At("reason").Text();
  record.hash = node.At("hash").Text();
  record.seconds = node.At("seconds").Number();
  record.frames = node.At("frames").Int();
  record.people = node.At("people").Int();
  const JsonNode counts = node.At("frames_by_status");
  for (const std::string& status : counts.Keys()) record.frames_by_status[status] = counts.At(status).Int();
  record.reprojection_median_px = node.At("reprojection_median_px").NumberOrNan();
  record.reprojection_p95_px = node.At("reprojection_p95_px").NumberOrNan();
  return record;
}

std::string ToCsv(std::vector<ClipRecord> records) {
  const auto key = [](const ClipRecord& record) {
    const double error = record.reprojection_p95_px;
    return std::tuple(record.status, std::isfinite(error) ? -error : 0.0, record.id);
  };
  std::sort(records.begin(), records.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::string text =
      "id,status,reprojection_p95_px,reprojection_median_px,frames,people,weak,interpolated,lost,seconds,reason\n";
  for (ClipRecord& record : records) {
    std::map<std::string, int>& frames = record.frames_by_status;
    text += Concatenate(record.id, ",", kClipStatusNames[static_cast<size_t>(record.status)], ",",
                        CsvCell(record.reprojection_p95_px), ",", CsvCell(record.reprojection_median_px), ",",
                        record.frames, ",", record.people, ",", frames["weak"], ",", frames["interpolated"], ",",
                        frames["lost"], ",", Fixed(record.seconds, 2), ",", std::quoted(record.reason, '"', '"'), "\n");
  }
  return text;
}

}  // namespace bodyloom
