// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/hand_and_face_points.h"
#include "data_tools/observations/json_folder.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// One frame as it stands in the file, before the convention is known.
using RawFrame = std::vector<DetectedPerson>;

/// Appends the people of one frame; `num_points` is fixed by the first person of the clip.
RawFrame FrameFromJson(const JsonNode& frame, size_t* num_points) {
  RawFrame people;
  const JsonNode list = frame.At("people");
  if (!list.is_array()) list.Fail("a list of people");
  for (size_t i = 0; i < list.size(); ++i) {
    const JsonNode entry = list.At(i);
    if (!entry.is_object()) entry.Fail("an object with 'pose_keypoints_2d'");
    const char* key = entry.Has("pose_keypoints_2d") ? "pose_keypoints_2d" : "pose_keypoints";
    if (!entry.Has(key)) continue;  // an empty object: a person who was tracked but not found
    const JsonNode values = entry.At(key);
    const std::vector<double> numbers = values.NumbersOrNan();
    if (numbers.empty()) continue;  // only a face or hands were found
    if (numbers.size() % 3 != 0) {
      throw std::runtime_error(values.place() + ": " + std::to_string(numbers.size()) +
                               " numbers, expected a multiple of 3 (x, y, confidence)");
    }
    if (*num_points == 0) *num_points = numbers.size() / 3;
    if (numbers.size() != 3 * *num_points) {
      throw std::runtime_error(values.place() + ": " + std::to_string(numbers.size() / 3) + " landmarks, expected " +
                               std::to_string(*num_points) + " as in the people before");
    }
    DetectedPerson person;
    person.points.resize(*num_points);
    for (size_t k = 0; k < *num_points; ++k) {
      person.points[k] = DetectedKeypoint(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
    }
    if (entry.Has("person_id") && entry.At("person_id").is_array()) {
      const std::vector<double> ids = entry.At("person_id").Numbers();
      if (ids.size() == 1 && ids[0] >= 0 && ids[0] < 1e9) person.identity = static_cast<int>(ids[0]);
    }
    person.hands_and_face =
        HandsAndFaceFrom({PointsAtKey(entry, "hand_left_keypoints_2d"), PointsAtKey(entry, "hand_right_keypoints_2d"),
                          PointsAtKey(entry, "face_keypoints_2d")},
                         entry.place());
    people.push_back(std::move(person));
  }
  return people;
}

/// Distance of point m from the middle of points a and b, when all three were seen.
void AddMidpointError(const DetectedPerson& person, int m, int a, int b, double* sum, int* count) {
  const Keypoint &pm = person.points[m], &pa = person.points[a], &pb = person.points[b];
  if (!(pm.confidence > 0 && pa.confidence > 0 && pb.confidence > 0)) return;
  *sum += std::hypot(pm.x - 0.5 * (pa.x + pb.x), pm.y - 0.5 * (pa.y + pb.y));
  ++*count;
}

/// BODY_25: neck (1) between the shoulders (2, 5), mid-hip (8) between the hips (9, 12). BODY_25B: nose (0) near the
/// middle of the eyes (1, 2), upper neck (17) near the middle of the shoulders (5, 6). The smaller mean error wins.
const KeypointConvention& Body25OrBody25B(const std::vector<RawFrame>& frames) {
  double error_25 = 0, error_25b = 0;
  int count_25 = 0, count_25b = 0;
  for (const RawFrame& frame : frames) {
    for (const DetectedPerson& person : frame) {
      AddMidpointError(person, 1, 2, 5, &error_25, &count_25);
      AddMidpointError(person, 8, 9, 12, &error_25, &count_25);
      AddMidpointError(person, 0, 1, 2, &error_25b, &count_25b);
      AddMidpointError(person, 17, 5, 6, &error_25b, &count_25b);
    }
  }
  if (count_25b == 0) return Body25();
  if (count_25 == 0) return Body25B();
  return error_25 / count_25 <= error_25b / count_25b ? Body25() : Body25B();
}

const KeypointConvention& FindConvention(size_t num_points, const std::string& wanted,
                                         const std::vector<RawFrame>& frames, const std::string& where) {
  const std::vector<const KeypointConvention*> known = {&Body25(), &Body25B(), &OpenPoseCoco18(), &Coco17(),
                                                        &Halpe26()};
  for (const KeypointConvention* convention : known) {
    if (!wanted.empty() && convention->name == wanted && (num_points == 0 || convention->names.size() == num_points)) {
      return *convention;
    }
  }
  if (!wanted.empty()) {
    throw std::runtime_error(where + ": " + std::to_string(num_points) + " landmarks a person, which is not '" +
                             wanted +
                             "'; expected body25, body25b, openpose_coco18, coco17 or halpe26 with its number");
  }
  if (num_points == 25 || num_points == 0) return Body25OrBody25B(frames);
  for (const KeypointConvention* convention : known) {
    if (convention->names.size() == num_points) return *convention;
  }
  throw std::runtime_error(where + ": " + std::to_string(num_points) +
                           " landmarks a person, expected 25 (BODY_25, BODY_25B), 18 (COCO with neck), 17 or 26");
}

}  // namespace

PeopleSequence ReadOpenPoseFolder(const std::string& folder, double fps, const std::string& convention,
                                  std::vector<std::string>* warnings) {
  const std::vector<std::string> names = JsonFilesOf(folder);
  if (names.empty()) ThrowFileError(folder, "no .json files, expected one OpenPose file a frame");
  std::vector<RawFrame> raw(names.size());
  size_t num_points = 0;
  ReadJsonFrames(
      folder, names, [&](size_t i, const JsonNode& document) { raw[i] = FrameFromJson(document, &num_points); },
      warnings);
  const KeypointConvention& found = FindConvention(num_points, convention, raw, folder);
  return PeopleOnGrid(std::move(raw), NumbersOrOrder(names), &found, fps, folder);
}

bool IsOpenPoseJson(const JsonNode& document) {
  if (document.Has("people")) return true;
  if (document.is_array()) return document.size() > 0 && document.At(0).Has("people");
  const std::vector<std::string> keys = document.Keys();
  return !keys.empty() && document.At(keys[0]).Has("people");
}

PeopleSequence OpenPoseFromJson(const JsonNode& document, double fps, const std::string& convention) {
  std::vector<RawFrame> raw;
  std::vector<int64_t> numbers;
  size_t num_points = 0;
  if (document.Has("people")) {
    raw.push_back(FrameFromJson(document, &num_points));
    numbers.push_back(0);
  } else if (document.is_array()) {
    for (size_t i = 0; i < document.size(); ++i) {
      raw.push_back(FrameFromJson(document.At(i), &num_points));
      numbers.push_back(static_cast<int64_t>(i));
    }
  } else {
    const std::vector<std::string> keys = document.Keys();
    for (const std::string& key : keys) raw.push_back(FrameFromJson(document.At(key), &num_points));
    numbers = NumbersOrOrder(keys);
  }
  const KeypointConvention& found = FindConvention(num_points, convention, raw, document.place());
  return PeopleOnGrid(std::move(raw), numbers, &found, fps, document.place());
}

}  // namespace bodyloom
