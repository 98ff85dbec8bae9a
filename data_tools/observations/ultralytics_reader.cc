// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <numeric>
#include <utility>

#include "data_tools/observations/json_folder.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

bool IsDetection(const JsonNode& node) {
  if (!node.Has("keypoints") || !node.At("keypoints").Has("x")) return node.Has("box") && node.Has("class");
  return node.At("keypoints").At("x").is_array();
}

DetectedPerson DetectionFromJson(const JsonNode& node, const KeypointConvention** convention) {
  if (!node.Has("keypoints")) {
    ThrowFileError(node.place(), "a detection without 'keypoints', expected those of a pose model (yolo…-pose)");
  }
  const JsonNode table = node.At("keypoints");
  const std::vector<double> x = table.At("x").NumbersOrNan();
  const int n = static_cast<int>(x.size());
  const std::vector<double> y = table.At("y").NumbersOrNan(n);
  const bool has_confidence = table.Has("visible") && !table.At("visible").is_null();
  const std::vector<double> confidence =
      has_confidence ? table.At("visible").NumbersOrNan(n) : std::vector<double>(x.size(), 1.0);
  RequireConventionOfCount(x.size(), table.place(), convention);
  DetectedPerson person;
  person.points.resize((*convention)->names.size());
  for (size_t k = 0; k < person.points.size(); ++k) {
    if (x[k] != 0 || y[k] != 0) person.points[k] = DetectedKeypoint(x[k], y[k], confidence[k]);
  }
  if (node.Has("track_id") && node.At("track_id").is_number()) {
    const double id = node.At("track_id").Number();
    if (id >= 0 && id < 1e9) person.identity = static_cast<int>(id);
  }
  return person;
}

std::vector<DetectedPerson> DetectionsOf(const JsonNode& list, const KeypointConvention** convention) {
  if (!list.is_array()) list.Fail("the list of an image's detections");
  std::vector<DetectedPerson> people;
  for (size_t i = 0; i < list.size(); ++i) people.push_back(DetectionFromJson(list.At(i), convention));
  return people;
}

}  // namespace

bool IsUltralyticsJson(const JsonNode& document) {
  if (!document.is_array()) return false;
  for (size_t i = 0; i < document.size(); ++i) {
    const JsonNode entry = document.At(i);
    if (IsDetection(entry)) return true;
    if (!entry.is_array()) return false;
    if (entry.size() > 0) return IsDetection(entry.At(0));
  }
  return false;
}

PeopleSequence UltralyticsFromJson(const JsonNode& document, double fps) {
  const KeypointConvention* convention = nullptr;
  std::vector<std::vector<DetectedPerson>> frames;
  if (document.size() > 0 && IsDetection(document.At(0))) {
    frames.push_back(DetectionsOf(document, &convention));
  } else {
    for (size_t t = 0; t < document.size(); ++t) frames.push_back(DetectionsOf(document.At(t), &convention));
  }
  std::vector<int64_t> numbers(frames.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return PeopleOnGrid(std::move(frames), numbers, convention, fps, document.place());
}

PeopleSequence ReadUltralyticsFolder(const std::string& folder, const std::vector<std::string>& names, double fps,
                                     std::vector<std::string>* warnings) {
  return ReadPeopleFrames(folder, names, fps, DetectionsOf, warnings);
}

}  // namespace bodyloom
