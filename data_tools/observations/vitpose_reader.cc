// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Names of the n landmarks, or of those that `skeleton` has from the first on.
std::vector<std::string> NamesOf(const JsonNode& document, size_t n) {
  std::vector<std::string> names;
  if (!document.Has("skeleton")) return names;
  const JsonNode skeleton = document.At("skeleton");
  while (names.size() < n && skeleton.Has(std::to_string(names.size()))) {
    names.push_back(LandmarkNameFrom(skeleton.At(std::to_string(names.size())).Text()));
  }
  return names;
}

KeypointConvention VitPoseConvention(const JsonNode& document, const JsonNode& person) {
  const size_t n = person.size();
  const std::vector<std::string> names = NamesOf(document, n);
  const KeypointConvention* by_count = ConventionOfCount(n);
  if (names.size() < n && by_count != nullptr && (names.empty() || names[0] == by_count->names[0])) return *by_count;
  if (names.size() < n) {
    ThrowFileError(person.place(), Concatenate(n, " landmarks of which 'skeleton' names ", names.size(),
                                               ", expected the names of all, or COCO's 17"));
  }
  if (std::none_of(names.begin(), names.end(), IsPersonLandmark)) {
    ThrowFileError(document.place(), "skeleton: " + PrintableList(names) + ", expected a person's landmarks");
  }
  return ConventionOfNames(names);
}

DetectedPerson PersonOfVitPose(const JsonNode& node, size_t num_points, size_t num_kept) {
  if (node.size() != num_points) {
    ThrowFileError(node.place(),
                   Concatenate(node.size(), " landmarks, expected ", num_points, " as in the people before"));
  }
  const std::vector<double> values = node.NumbersOrNan(static_cast<int>(3 * num_points));
  DetectedPerson person;
  for (size_t k = 0; k < num_kept; ++k) {
    person.points.push_back(DetectedKeypoint(values[3 * k + 1], values[3 * k], values[3 * k + 2]));
  }
  return person;
}

/// The number that names a person, −1 for another name.
int IdentityFrom(const std::string& key) {
  int identity = -1;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), identity);
  return error == std::errc() && end == key.data() + key.size() ? identity : -1;
}

}  // namespace

bool IsVitPoseJson(const JsonNode& document) {
  if (!document.Has("keypoints") || !document.At("keypoints").is_array()) return false;
  const JsonNode frames = document.At("keypoints");
  for (size_t t = 0; t < frames.size(); ++t) {
    const JsonNode frame = frames.At(t);
    if (!frame.is_object()) return false;
    const std::vector<std::string> keys = frame.Keys();
    if (!keys.empty()) return frame.At(keys[0]).is_array() && IdentityFrom(keys[0]) >= 0;
  }
  return document.Has("skeleton");
}

PeopleSequence VitPoseFromJson(const JsonNode& document, double fps) {
  const JsonNode list = document.At("keypoints");
  std::optional<KeypointConvention> convention;
  size_t num_points = 0;
  std::vector<std::vector<DetectedPerson>> frames(list.size());
  for (size_t t = 0; t < list.size(); ++t) {
    const JsonNode frame = list.At(t);
    if (!frame.is_object()) frame.Fail("a table of people");
    for (const std::string& key : frame.Keys()) {
      const JsonNode node = frame.At(key);
      if (!convention) {
        convention = VitPoseConvention(document, node);
        num_points = node.size();
      }
      frames[t].push_back(PersonOfVitPose(node, num_points, convention->names.size()));
      frames[t].back().identity = IdentityFrom(key);
    }
  }
  std::vector<int64_t> numbers(frames.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return PeopleOnGrid(std::move(frames), numbers, convention ? &*convention : nullptr, fps, document.place());
}

}  // namespace bodyloom
