// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/detect/detect_clip.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/observations/part_labels.h"
#include "bodyloom/data_tools/observations/people_npz.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/percentile.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/fixed_text.h"
#include "bodyloom/pipelines/report_json.h"

namespace bodyloom {
namespace {

constexpr float kVisible = 0.5F;

void CheckFiles(const DetectClipRequest& request) {
  if (request.out.empty() && request.mask.empty() && request.json.empty()) {
    throw RequestError("nothing to write: expected --out, --mask or --json");
  }
  RequireReadable(request.detect.video, "video");
  RequireDistinct({request.detect.video}, {request.out, request.mask, request.json});
  for (const std::string& path : {request.out, request.mask, request.json}) RequireWritable(path);
}

double HeightPx(const DetectedPerson& person) {
  const auto lower = [](const Keypoint& a, const Keypoint& b) { return a.y < b.y; };
  const auto [top, bottom] = std::minmax_element(person.points.begin(), person.points.end(), lower);
  return bottom->y - top->y;
}

double VisibleShare(const DetectedPerson& person) {
  const auto seen = [](const Keypoint& p) { return p.confidence >= kVisible; };
  return double(std::count_if(person.points.begin(), person.points.end(), seen)) / double(person.points.size());
}

}  // namespace

std::vector<FoundPerson> FoundPeople(const PeopleSequence& people) {
  std::vector<FoundPerson> found;
  for (const PersonTrack& track : LinkPeople(people)) {
    FoundPerson& person = found.emplace_back();
    person.frames = int(track.detections.size());
    person.first_s = people.timestamps[size_t(track.detections.front().first)];
    person.last_s = people.timestamps[size_t(track.detections.back().first)];
    std::vector<double> heights;
    for (const auto& [frame, index] : track.detections) {
      const DetectedPerson& detection = people.frames[size_t(frame)][size_t(index)];
      heights.push_back(HeightPx(detection));
      person.visible += VisibleShare(detection) / double(track.detections.size());
    }
    person.height_px = Percentile(heights, 50);
  }
  return found;
}

DetectClipReport DetectClip(const DetectClipRequest& request, const PipelineCallbacks& callbacks) {
  CheckFiles(request);
  StageClock clock;
  DetectPeopleRequest detect = request.detect;
  detect.detector.masks = !request.mask.empty();
  callbacks.Begin("detecting people");
  clock.Begin("detect");
  const DetectedClip clip = DetectPeople(detect, callbacks);
  DetectClipReport report;
  report.video = detect.video;
  report.network = detect.detector.network;
  report.width = clip.people.image_width;
  report.height = clip.people.image_height;
  report.frames = int(clip.people.frames.size());
  report.frames_with_people = int(std::count_if(clip.people.frames.begin(), clip.people.frames.end(),
                                                [](const auto& people) { return !people.empty(); }));
  report.people = FoundPeople(clip.people);
  report.detector = clip.detector;
  if (report.people.empty()) {
    throw std::runtime_error(Concatenate(detect.video, ": nobody was found in ", report.frames, " frames"));
  }
  std::optional<PersonTrack> masked;
  if (!request.mask.empty()) masked = PersonOf(clip.people, request.person, detect.video);
  clock.Begin("write");
  if (!request.out.empty()) {
    WritePeople(request.out, clip.people);
    report.outputs.push_back(request.out);
  }
  if (masked) {
    WriteMask(request.mask, MaskOfPerson(clip, *masked));
    report.outputs.push_back(request.mask);
  }
  clock.End();
  report.seconds = clock.seconds();
  report.total_seconds = clock.total();
  if (!request.json.empty()) {
    report.outputs.push_back(request.json);
    WriteFileAtomically(request.json, ToJson(report));
  }
  return report;
}

std::string ToJson(const DetectClipReport& report) {
  nlohmann::ordered_json people = nlohmann::ordered_json::array();
  for (const FoundPerson& person : report.people) {
    people.push_back({{"frames", person.frames},
                      {"first_s", person.first_s},
                      {"last_s", person.last_s},
                      {"height_px", person.height_px},
                      {"visible", person.visible}});
  }
  const nlohmann::ordered_json json = {{"video", report.video},
                                       {"image_size", {report.width, report.height}},
                                       {"frames", report.frames},
                                       {"frames_with_people", report.frames_with_people},
                                       {"network", ToText(report.network)},
                                       {"people", people},
                                       {"searches", report.detector.searches},
                                       {"regions", report.detector.regions},
                                       {"search_seconds", report.detector.search_seconds},
                                       {"landmark_seconds", report.detector.landmark_seconds},
                                       {"seconds", ToJson(report.seconds)},
                                       {"total_seconds", report.total_seconds}};
  return json.dump(1) + "\n";
}

std::string ToText(const DetectClipReport& report) {
  std::string text = Concatenate("frames   ", report.frames, " of ", report.width, "x", report.height, " pixels, ",
                                 report.frames_with_people, " with people\n");
  constexpr size_t kMostShown = 10;
  for (size_t i = 0; i < std::min(kMostShown, report.people.size()); ++i) {
    const FoundPerson& person = report.people[i];
    text += Concatenate("person ", i, " ", person.frames, " frames, ", Fixed(person.first_s, 2), " to ",
                        Fixed(person.last_s, 2), " s, ", Fixed(person.height_px, 0), " px tall, ",
                        Fixed(100 * person.visible, 0), " % of the landmarks visible\n");
  }
  if (report.people.size() > kMostShown) text += Concatenate("and ", report.people.size() - kMostShown, " more\n");
  text += Concatenate("time     ", Fixed(report.total_seconds, 2), " s, ",
                      Fixed(report.frames / std::max(1e-9, report.total_seconds), 1), " frames a second with ",
                      ToText(report.network), "\n");
  for (const std::string& path : report.outputs) text += "wrote    " + path + "\n";
  return text;
}

}  // namespace bodyloom
