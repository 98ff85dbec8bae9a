// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/hand_and_face_points.h"
#include "data_tools/observations/keypoint_conventions.h"

namespace bodyloom {
namespace {

constexpr const char* kListKeys[] = {"keypoints", "landmarks", "pose_landmarks", "poseLandmarks"};

/// The list inside {"keypoints": […]}; the node itself when it is a list.
const char* ListKey(const JsonNode& node) {
  for (const char* key : kListKeys) {
    if (node.Has(key) && node.At(key).is_array()) return key;
  }
  return nullptr;
}

bool IsNamedTable(const JsonNode& node) {
  const std::vector<std::string> keys = node.Keys();
  return !keys.empty() && node.At(keys[0]).Has("x");
}

/// A list of points: its first entry is [x, y, …] or {"x": …}.
bool IsPointList(const JsonNode& node) {
  if (!node.is_array() || node.size() == 0) return false;
  const JsonNode first = node.At(0);
  return first.Has("x") ||
         (first.is_array() && first.size() >= 2 && (first.At(0).is_number() || first.At(0).is_null()));
}

bool IsPerson(const JsonNode& node) { return ListKey(node) != nullptr || IsNamedTable(node) || IsPointList(node); }

bool IsEmptyFrame(const JsonNode& node) {
  return node.is_null() || ((node.is_array() || node.is_object()) && node.size() == 0);
}

bool IsFrame(const JsonNode& node) {
  return IsPerson(node) || (node.is_array() && node.size() > 0 && IsPerson(node.At(0)));
}

Keypoint PointFromJson(const JsonNode& node) {
  if (node.is_array()) {
    const std::vector<double> values = node.NumbersOrNan();
    if (values.size() < 2 || values.size() > 5) node.Fail("[x, y], [x, y, z] or [x, y, z, visibility]");
    return {static_cast<float>(values[0]), static_cast<float>(values[1]),
            values.size() >= 4 ? static_cast<float>(values[3]) : 1.0F};
  }
  Keypoint point{static_cast<float>(node.At("x").NumberOrNan()), static_cast<float>(node.At("y").NumberOrNan()), 1.0F};
  for (const char* key : {"score", "visibility", "confidence"}) {
    if (node.Has(key) && !node.At(key).is_null()) point.confidence = static_cast<float>(node.At(key).Number());
  }
  return point;
}

/// Points of a hand or a face, under MediaPipe's name in Python or in JavaScript; none when there are none.
std::vector<Keypoint> PartFromJson(const JsonNode& person, const char* name, const char* other_name) {
  std::vector<Keypoint> points;
  for (const char* key : {name, other_name}) {
    if (!person.Has(key) || IsEmptyFrame(person.At(key))) continue;
    const JsonNode list = person.At(key);
    if (!list.is_array()) list.Fail("a list of landmarks");
    for (size_t k = 0; k < list.size(); ++k) {
      points.push_back(PointFromJson(list.At(k)));
      points.back().confidence = 1;  // their visibility is not estimated: files have none, or 0
    }
    break;
  }
  return points;
}

DetectedPerson PersonFromJson(const JsonNode& node, const KeypointConvention& convention) {
  DetectedPerson person;
  if (const char* key = ListKey(node)) {
    person = PersonFromJson(node.At(key), convention);
    person.hands_and_face = HandsAndFaceFrom({PartFromJson(node, "left_hand_landmarks", "leftHandLandmarks"),
                                              PartFromJson(node, "right_hand_landmarks", "rightHandLandmarks"),
                                              PartFromJson(node, "face_landmarks", "faceLandmarks")},
                                             node.place());
    return person;
  }
  if (node.is_array()) {
    if (node.size() != convention.names.size()) {
      throw std::runtime_error(node.place() + ": " + std::to_string(node.size()) + " landmarks, expected " +
                               std::to_string(convention.names.size()) + " (" + convention.name + ")");
    }
    for (size_t k = 0; k < node.size(); ++k) person.points.push_back(PointFromJson(node.At(k)));
    return person;
  }
  person.points.resize(convention.names.size());
  for (const std::string& name : node.Keys()) {
    const auto found = std::find(convention.names.begin(), convention.names.end(), LandmarkNameFrom(name));
    if (found == convention.names.end()) {
      throw std::runtime_error(node.place() + ": landmark '" + PrintableText(name) + "' is not one of " +
                               convention.name);
    }
    person.points[found - convention.names.begin()] = PointFromJson(node.At(name));
  }
  return person;
}

/// 33 landmarks, or COCO's 17.
const KeypointConvention& ConventionOf(const JsonNode& person) {
  if (const char* key = ListKey(person)) return ConventionOf(person.At(key));
  if (person.is_array()) {
    if (person.size() == Coco17().names.size()) return Coco17();
    if (person.size() == MediaPipe33().names.size()) return MediaPipe33();
    throw std::runtime_error(person.place() + ": " + std::to_string(person.size()) +
                             " landmarks, expected 33 (BlazePose) or 17 (COCO)");
  }
  for (const std::string& name : person.Keys()) {
    if (std::find(Coco17().names.begin(), Coco17().names.end(), LandmarkNameFrom(name)) == Coco17().names.end()) {
      return MediaPipe33();
    }
  }
  return Coco17();
}

JsonNode FrameList(const JsonNode& document) { return document.Has("frames") ? document.At("frames") : document; }

/// Confidences outside [0, 1] can only be logits; then all of them are.
void LogitsToProbabilities(PeopleSequence* people) {
  bool are_logits = false;
  for (const auto& frame : people->frames) {
    for (const auto& person : frame) {
      for (const Keypoint& p : person.points) are_logits |= p.confidence < 0 || p.confidence > 1;
    }
  }
  if (!are_logits) return;
  for (auto& frame : people->frames) {
    for (auto& person : frame) {
      for (Keypoint& p : person.points) p.confidence = 1 / (1 + std::exp(-p.confidence));
    }
  }
}

}  // namespace

bool IsBlazePoseJson(const JsonNode& document) {
  const JsonNode frames = FrameList(document);
  if (!frames.is_array()) return false;
  for (size_t i = 0; i < frames.size(); ++i) {
    const JsonNode frame = frames.At(i);
    if (!IsEmptyFrame(frame)) return IsFrame(frame);
  }
  return false;
}

PeopleSequence BlazePoseFromJson(const JsonNode& document, double fps) {
  const JsonNode frames = FrameList(document);
  PeopleSequence people;
  std::vector<int64_t> numbers;
  for (size_t t = 0; t < frames.size(); ++t) {
    const JsonNode frame = frames.At(t);
    numbers.push_back(static_cast<int64_t>(t));
    auto& detections = people.frames.emplace_back();
    if (IsEmptyFrame(frame)) continue;
    if (!IsFrame(frame)) frame.Fail("a frame of landmarks");
    const bool is_one = IsPerson(frame);
    for (size_t i = 0; i < (is_one ? 1 : frame.size()); ++i) {
      const JsonNode person = is_one ? frame : frame.At(i);
      if (people.convention.names.empty()) people.convention = ConventionOf(person);
      detections.push_back(PersonFromJson(person, people.convention));
    }
  }
  LogitsToProbabilities(&people);
  people.timestamps = MakeFrameGrid(numbers, fps, document.place()).timestamps;
  return people;
}

}  // namespace bodyloom
