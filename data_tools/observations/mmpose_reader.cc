// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <utility>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/hand_and_face_points.h"
#include "data_tools/observations/json_folder.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

bool IsMmposePerson(const JsonNode& node) { return node.Has("keypoints") && node.Has("keypoint_scores"); }
bool IsMmposeFrame(const JsonNode& node) { return node.Has("frame_id") && node.Has("instances"); }

/// Refuses a landmark order with as many landmarks as a supported one but other ones (Human3.6M has 17 too).
void CheckNames(const JsonNode& document, size_t num_points) {
  if (!document.Has("meta_info") || !document.At("meta_info").Has("keypoint_id2name")) return;
  const JsonNode names = document.At("meta_info").At("keypoint_id2name");
  if (!names.Has("0") || !names.At("0").is_string() || names.At("0").Text() == Coco17().names[0]) return;
  ThrowFileError(names.place(),
                 Concatenate(num_points, " landmarks of which the first is '", PrintableText(names.At("0").Text()),
                             "', expected COCO's, Halpe's or COCO-WholeBody's, which begin with the nose"));
}

DetectedPerson PersonFromJson(const JsonNode& node, const KeypointConvention** convention) {
  const JsonNode points = node.At("keypoints");
  const size_t n = points.size();
  RequireConventionOfCount(n, points.place(), convention);
  const std::vector<double> scores = node.At("keypoint_scores").NumbersOrNan(static_cast<int>(n));
  DetectedPerson person;
  for (size_t k = 0; k < n; ++k) {
    const JsonNode point = points.At(k);
    if (point.size() == 3) {
      ThrowFileError(point.place(), "3 numbers: keypoints that were lifted to 3D, expected pixels (x, y)");
    }
    const std::vector<double> xy = point.NumbersOrNan(2);
    person.points.push_back(DetectedKeypoint(xy[0], xy[1], scores[k]));
  }
  const size_t num_body = (*convention)->names.size();
  person.hands_and_face = HandsAndFaceOfWholeBody(person.points, num_body, points.place());
  person.points.resize(num_body);
  return person;
}

std::vector<DetectedPerson> PeopleOf(const JsonNode& list, const KeypointConvention** convention) {
  if (!list.is_array()) list.Fail("a list of people");
  std::vector<DetectedPerson> people;
  for (size_t i = 0; i < list.size(); ++i) people.push_back(PersonFromJson(list.At(i), convention));
  return people;
}

}  // namespace

bool IsMmposeJson(const JsonNode& document) {
  if (document.Has("instance_info")) return true;
  return document.is_array() && document.size() > 0 &&
         (IsMmposePerson(document.At(0)) || IsMmposeFrame(document.At(0)));
}

PeopleSequence MmposeFromJson(const JsonNode& document, double fps) {
  const KeypointConvention* convention = nullptr;
  std::vector<std::vector<DetectedPerson>> frames;
  std::vector<int64_t> numbers;
  const bool counts_from_one = document.Has("instance_info");
  const JsonNode list = counts_from_one ? document.At("instance_info") : document;
  if (!list.is_array()) list.Fail("a list of frames");
  if (!counts_from_one && list.size() > 0 && IsMmposePerson(list.At(0))) {
    frames.push_back(PeopleOf(list, &convention));
    numbers.push_back(0);
  } else {
    for (size_t i = 0; i < list.size(); ++i) {
      frames.push_back(PeopleOf(list.At(i).At("instances"), &convention));
      numbers.push_back(list.At(i).At("frame_id").Integer() - (counts_from_one ? 1 : 0));
    }
  }
  if (convention != nullptr) CheckNames(document, convention->names.size());
  return PeopleOnGrid(std::move(frames), numbers, convention, fps, document.place());
}

PeopleSequence ReadMmposeFolder(const std::string& folder, const std::vector<std::string>& names, double fps,
                                std::vector<std::string>* warnings) {
  return ReadPeopleFrames(folder, names, fps, PeopleOf, warnings);
}

}  // namespace bodyloom
