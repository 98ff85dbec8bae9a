// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/batch_clip.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "bodyloom/data_tools/detection/model_files.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/sha256.h"
#include "bodyloom/pipelines/track/track_clip.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

const TrackRequest& TrackOf(const BatchClip& clip) {
  const auto* people = std::get_if<TrackPeopleClipRequest>(&clip.request);
  return people != nullptr ? people->track : std::get<TrackRequest>(clip.request);
}

/// BlazePose's files that detection would read; none where another detector finds and measures people.
std::vector<std::string> NetworkFiles(const TrackRequest& request) {
  const FrameDetectorOptions& detector = request.detector;
  if (!DetectsPeople(request) || (!detector.pose_model.empty() && !detector.box_model.empty())) return {};
  std::vector<std::string> files;
  const auto add = [&](const char* name) {
    // Another detector may do without: then they need not be there.
    try {
      files.push_back(FindModelFile(name, detector.models));
    } catch (const std::runtime_error&) {
      if (detector.pose_model.empty()) throw;
    }
  };
  add(kPoseDetectorFile);
  switch (detector.blazepose.network) {
    case PoseNetworkSize::kLite:
      add(kPoseLandmarkLiteFile);
      break;
    case PoseNetworkSize::kFull:
      add(kPoseLandmarkFullFile);
      break;
    case PoseNetworkSize::kHeavy:
      add(kPoseLandmarkHeavyFile);
      break;
  }
  return files;
}

std::string NameAlone(const std::string& path) { return path.empty() ? path : fs::path(path).filename().string(); }

void NameAlone(std::vector<std::string>* paths) {
  for (std::string& path : *paths) path = NameAlone(path);
}

void AddCounts(const TrackSequenceSummary& solve, ClipRecord* record) {
  for (const auto& [status, frames] : solve.frames_by_status) record->frames_by_status[status] += frames;
  // fmax passes over NaN, which both are at first.
  record->reprojection_median_px = std::fmax(record->reprojection_median_px, solve.reprojection_median_px);
  record->reprojection_p95_px = std::fmax(record->reprojection_p95_px, solve.reprojection_p95_px);
  ++record->people;
}

ClipRecord TrackOne(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks) {
  TrackRequest request = std::get<TrackRequest>(clip.request);
  const auto in_folder = [&](const char* name) { return (fs::path(folder) / name).string(); };
  request.out = in_folder("track.npz");
  if (clip.overlay) request.overlay = in_folder("overlay.mp4");
  if (clip.report) request.report = in_folder("report.html");
  TrackReport report = TrackClip(request, callbacks);
  NameAlone(&report.outputs);
  WriteFileAtomically(in_folder("report.json"), ToJson(report));
  ClipRecord record;
  record.frames = report.num_frames;
  AddCounts(report.solve, &record);
  return record;
}

ClipRecord TrackEverybody(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks) {
  TrackPeopleClipRequest request = std::get<TrackPeopleClipRequest>(clip.request);
  request.out = folder;
  request.overlay = clip.overlay;
  request.report = clip.report;
  TrackPeopleReport report = TrackPeopleClip(request, callbacks);
  NameAlone(&report.outputs);
  for (TrackedPerson& person : report.people) person.track = NameAlone(person.track);
  std::replace(report.outputs.begin(), report.outputs.end(), std::string("summary.json"), std::string("report.json"));
  fs::remove(fs::path(folder) / "summary.json");
  WriteFileAtomically((fs::path(folder) / "report.json").string(), ToJson(report));
  ClipRecord record;
  record.frames = report.num_frames;
  for (const TrackedPerson& person : report.people) {
    if (person.solve.IsUsable()) AddCounts(person.solve, &record);
  }
  return record;
}

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
    sha.AddField(name);
    if (IsPathSetting(name, value)) {
      sha.AddField(fs::path(value).lexically_normal().filename().string());
      sha.AddField(Sha256OfTree(value));
    } else {
      sha.AddField(value);
    }
  }
  sha.AddField("networks");
  for (const std::string& file : NetworkFiles(TrackOf(clip))) sha.AddField(Sha256OfFile(file));
  return sha.Hex();
}

ClipRecord TrackBatchClip(const BatchClip& clip, const std::string& folder, const PipelineCallbacks& callbacks) {
  const bool one = std::holds_alternative<TrackRequest>(clip.request);
  ClipRecord record = one ? TrackOne(clip, folder, callbacks) : TrackEverybody(clip, folder, callbacks);
  record.id = clip.id;
  record.verb = VerbOf(clip);
  record.status = ClipStatus::kDone;
  return record;
}

}  // namespace bodyloom
