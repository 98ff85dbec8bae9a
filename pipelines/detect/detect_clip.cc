// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/detect_clip.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/part_labels.h"
#include "data_tools/observations/people_npz.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/scene/observations.h"
#include "pipelines/detect/cut_masks.h"
#include "pipelines/detect/upright_people.h"
#include "pipelines/files.h"
#include "pipelines/report_json.h"
#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

constexpr float kVisible = 0.5F;

void CheckFiles(const DetectClipRequest& request) {
  const std::vector<std::string> outputs = {request.out, request.mask, request.dense, request.json};
  if (std::all_of(outputs.begin(), outputs.end(), [](const std::string& path) { return path.empty(); })) {
    throw RequestError("nothing to write: expected --out, --mask, --dense-out or --json");
  }
  if (!request.dense.empty() && !request.dense.ends_with(".npz")) {
    throw RequestError(request.dense + ": dense keypoints are written as .npz");
  }
  const FrameDetectorOptions& detector = request.detect.detector;
  RequireReadable(request.detect.video, "video");
  RequirePoseModels(detector);
  if (!request.mask.empty() && !detector.pose_model.empty()) {
    throw RequestError("--mask is BlazePose's: leave it out with --pose-model");
  }
  RequireDistinct({request.detect.video, request.body, detector.pose_model, detector.box_model}, outputs);
  for (const std::string& path : outputs) RequireWritable(path);
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

/// Everybody's landmarks, and what the report says of them.
DetectedClip DetectLandmarks(const DetectClipRequest& request, const PipelineCallbacks& callbacks, StageClock* clock,
                             DetectClipReport* report) {
  DetectPeopleRequest detect = request.detect;
  detect.detector.blazepose.masks = !request.mask.empty();
  if (request.out.empty()) detect.detector.hands_and_faces = HandsAndFaceChoice::kOff;  // nothing would show them
  callbacks.Begin("detecting people");
  clock->Begin("detect");
  DetectedClip clip = DetectPeople(detect, callbacks);
  SayAdviceOnTurn(detect.video, clip.people, callbacks);
  const auto has_people = [](const std::vector<DetectedPerson>& people) { return !people.empty(); };
  FoundLandmarks& found = report->landmarks.emplace();
  found.network = FrameDetectorName(detect.detector);
  found.frames_with_people = int(std::count_if(clip.people.frames.begin(), clip.people.frames.end(), has_people));
  found.people = FoundPeople(clip.people, LinkPeople(clip.people));
  found.detector = clip.detector;
  report->width = clip.people.image_width;
  report->height = clip.people.image_height;
  report->frames = int(clip.people.frames.size());
  if (found.people.empty()) {
    throw NoPersonFound(Concatenate(detect.video, ": nobody was found in ", report->frames, " frames"));
  }
  if (!request.mask.empty()) {
    clock->Begin("masks");
    found.mask_cut = !request.coarse_mask && CutMasks(detect, 0, &clip, callbacks);
  }
  return clip;
}

void ReportDense(const DetectedDense& detected, DetectClipReport* report) {
  size_t points = 0;
  for (const auto& frame : detected.dense.frames) points += frame.size();
  report->width = detected.dense.image_width;
  report->height = detected.dense.image_height;
  report->frames = detected.dense.num_frames();
  report->dense = {detected.people, detected.frames_seen, double(points) / detected.frames_seen};
}

nlohmann::ordered_json PeopleJson(const std::vector<FoundPerson>& people) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FoundPerson& person : people) {
    list.push_back({{"frames", person.frames},
                    {"joined", person.joined},
                    {"first_s", person.first_s},
                    {"last_s", person.last_s},
                    {"height_px", person.height_px},
                    {"visible", person.visible}});
  }
  return list;
}

std::string ToText(const std::vector<FoundPerson>& people) {
  std::string text;
  constexpr size_t kMaxShown = 10;
  for (size_t i = 0; i < std::min(kMaxShown, people.size()); ++i) {
    const FoundPerson& person = people[i];
    text += Concatenate("person ", i, " ", person.frames, " frames, ", Fixed(person.first_s, 2), " to ",
                        Fixed(person.last_s, 2), " s, ", Fixed(person.height_px, 0), " px tall, ",
                        Fixed(100 * person.visible, 0), " % of the landmarks visible");
    text +=
        person.joined > 0 ? Concatenate("; found ", person.joined + 1, " times over in the same body, joined\n") : "\n";
  }
  if (people.size() > kMaxShown) text += Concatenate("and ", people.size() - kMaxShown, " more\n");
  return text;
}

}  // namespace

std::vector<FoundPerson> FoundPeople(const PeopleSequence& people, const std::vector<PersonTrack>& tracks) {
  std::vector<FoundPerson> found;
  for (const PersonTrack& track : tracks) {
    FoundPerson& person = found.emplace_back();
    person.frames = int(track.detections.size());
    person.joined = track.joined;
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

DetectClipReport DetectClip(const DetectClipRequest& given_request, const PipelineCallbacks& callbacks) {
  CheckFiles(given_request);
  DetectClipRequest request = given_request;
  if (request.find_turn) request.detect.span.turn_deg = FindTurn(request.detect, callbacks);
  const bool wants_dense = !request.dense.empty();
  BODYLOOM_CHECK(!wants_dense || request.dense_detector, "DetectClip: dense keypoints without a detector");
  DetectClipReport report;
  report.video = request.detect.video;
  const std::shared_ptr<const BodyModel> body = wants_dense ? BodyOrBuiltin(request.body) : nullptr;
  const bool wants_landmarks = !wants_dense || !request.out.empty() || !request.mask.empty();
  StageClock clock;
  DetectedClip clip;
  std::optional<PersonTrack> masked;
  if (wants_landmarks) {
    clip = DetectLandmarks(request, callbacks, &clock, &report);
    if (!request.mask.empty()) masked = PersonOf(clip.people, request.person, report.video);
  }
  DetectedDense dense;
  if (wants_dense) {
    callbacks.Begin("detecting dense keypoints");
    clock.Begin("dense");
    dense = DetectDense({report.video, request.detect.span, request.person, {}}, request.dense_detector, *body,
                        wants_landmarks ? &clip.people : nullptr, callbacks);
    ReportDense(dense, &report);
  }
  clock.Begin("write");
  const auto wrote = [&report](const std::string& path) { report.outputs.push_back(path); };
  if (!request.out.empty()) WritePeople(request.out, clip.people), wrote(request.out);
  if (masked) WriteMask(request.mask, MaskOfPerson(clip, *masked)), wrote(request.mask);
  if (wants_dense) WriteObservations(request.dense, nullptr, &dense.dense), wrote(request.dense);
  clock.End();
  report.seconds = clock.seconds();
  report.processor_seconds = clock.processor_seconds();
  report.total_seconds = clock.total();
  if (!request.json.empty()) {
    wrote(request.json);
    WriteFileAtomically(request.json, ToJson(report));
  }
  return report;
}

std::string ToJson(const DetectClipReport& report) {
  nlohmann::ordered_json json = {
      {"video", report.video}, {"image_size", {report.width, report.height}}, {"frames", report.frames}};
  if (report.landmarks) {
    const FoundLandmarks& found = *report.landmarks;
    json["frames_with_people"] = found.frames_with_people;
    json["frames_detected"] = found.detector.frames;
    json["network"] = found.network;
    json["people"] = PeopleJson(found.people);
    json["searches"] = found.detector.searches;
    json["regions"] = found.detector.regions;
    json["search_seconds"] = found.detector.search_seconds;
    json["landmark_seconds"] = found.detector.landmark_seconds;
    AddHandsAndFaces(found.detector.hands_and_faces, &json);
    if (found.mask_cut) json["masks_cut"] = *found.mask_cut;
  }
  if (report.dense) {
    json["dense"] = {{"people", report.dense->people},
                     {"frames_seen", report.dense->frames_seen},
                     {"keypoints", report.dense->keypoints}};
  }
  json["seconds"] = ToJson(report.seconds);
  json["processor_seconds"] = ToJson(report.processor_seconds);
  json["total_seconds"] = report.total_seconds;
  return json.dump(1) + "\n";
}

std::string ToText(const DetectClipReport& report) {
  std::string text = Concatenate("frames   ", report.frames, " of ", report.width, "x", report.height, " pixels");
  if (report.landmarks) {
    text += Concatenate(", ", report.landmarks->frames_with_people, " with people\n", ToText(report.landmarks->people));
    text += ToText(report.landmarks->detector.hands_and_faces);
    if (const auto cut = report.landmarks->mask_cut) text += Concatenate("masks    ", MasksText(*cut), "\n");
  } else {
    text += "\n";
  }
  if (report.dense) {
    text += Concatenate("dense    ", Fixed(report.dense->keypoints, 0), " keypoints a frame in ",
                        report.dense->frames_seen, " frames, one of ", report.dense->people, " people\n");
  }
  text += Concatenate("time     ", Fixed(report.total_seconds, 2), " s, ",
                      Fixed(report.frames / std::max(1e-9, report.total_seconds), 1), " frames a second",
                      report.landmarks ? " with " + report.landmarks->network : "", "\n");
  for (const std::string& path : report.outputs) text += "wrote    " + path + "\n";
  return text;
}

}  // namespace bodyloom
