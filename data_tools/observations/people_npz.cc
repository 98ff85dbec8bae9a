// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/people_npz.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/ndarray.h"
#include "data_tools/observations/observations_npz.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {}  // namespace

void WritePeople(const std::string& path, const PeopleSequence& people) {
  const size_t num_points = people.convention.names.size();
  BODYLOOM_CHECK(people.frames.size() == people.timestamps.size(), "WritePeople: ", people.frames.size(),
                 " frames and ", people.timestamps.size(), " timestamps");
  static_assert(sizeof(Keypoint) == 3 * sizeof(float));
  std::vector<int32_t> frames, identities;
  std::vector<float> points;
  for (size_t t = 0; t < people.frames.size(); ++t) {
    for (const DetectedPerson& person : people.frames[t]) {
      BODYLOOM_CHECK(person.points.size() == num_points, "WritePeople: a person with ", person.points.size(),
                     " landmarks, the convention has ", num_points);
      frames.push_back(int32_t(t));
      identities.push_back(person.identity);
      const auto* first = reinterpret_cast<const float*>(person.points.data());
      points.insert(points.end(), first, first + 3 * num_points);
    }
  }
  const auto rows = int64_t(frames.size());
  const int32_t size[2] = {people.image_width, people.image_height};
  NpzArrays arrays;
  arrays["timestamps"] = NdArray::FromDoubles(people.timestamps.data(), {int64_t(people.timestamps.size())});
  arrays["image_size"] = NdArray::FromInts32(size, {2});
  arrays["people_frame"] = NdArray::FromInts32(frames.data(), {rows});
  arrays["people_identity"] = NdArray::FromInts32(identities.data(), {rows});
  arrays["people_keypoints"] = NdArray::FromFloats(points.data(), {rows, int64_t(num_points), 3});
  arrays["keypoint_names"] = NdArray::FromStrings(people.convention.names);
  arrays["keypoint_convention"] = NdArray::FromString(people.convention.name);
  WriteNpz(path, arrays);
}

bool HasPeople(const NpzArrays& arrays) { return arrays.find("people_frame") != arrays.end(); }

PeopleSequence PeopleFromNpz(const NpzArrays& arrays, const std::string& where) {
  PeopleSequence people;
  people.timestamps = TimestampsFromNpz(arrays, where);
  people.frames.resize(people.timestamps.size());
  ImageSizeFromNpz(arrays, where, &people.image_width, &people.image_height);
  people.convention = {ConventionNameFromNpz(arrays), KeypointNamesFromNpz(arrays, where)};
  const std::vector<int64_t> frames = WholeNumbers(RequireArray(arrays, "people_frame", where), "people_frame", where);
  const std::vector<int64_t> identities =
      WholeNumbers(RequireArray(arrays, "people_identity", where), "people_identity", where);
  const auto rows = int64_t(frames.size()), num_points = int64_t(people.convention.names.size());
  if (identities.size() != frames.size()) {
    ThrowFileError(where, "people_identity",
                   Concatenate(identities.size(), " entries, expected the ", rows, " of people_frame"));
  }
  const NdArray& array = RequireArray(arrays, "people_keypoints", where);
  if (!array.is_number() || array.shape != std::vector<int64_t>{rows, num_points, 3}) {
    ThrowFileError(where, "people_keypoints",
                   Concatenate("shape ", array.ShapeText(), ", expected numbers, ", rows, " x ", num_points, " x 3"));
  }
  const std::vector<float> values = array.ToFloats();
  for (int64_t row = 0; row < rows; ++row) {
    const std::string entry = "entry " + std::to_string(row);
    if (frames[row] < 0 || frames[row] >= int64_t(people.frames.size()) || (row > 0 && frames[row] < frames[row - 1])) {
      ThrowFileError(
          where, "people_frame",
          Concatenate(entry, " is ", frames[row], ", expected 0 to ", people.frames.size() - 1, ", not decreasing"));
    }
    if (identities[row] < -1 || identities[row] > 1'000'000'000) {
      ThrowFileError(where, "people_identity",
                     Concatenate(entry, " is ", identities[row], ", expected -1 or a number from 0"));
    }
    DetectedPerson person;
    person.identity = int(identities[row]);
    person.points.resize(size_t(num_points));
    for (int64_t k = 0; k < num_points; ++k) {
      const float* p = &values[size_t(row * num_points + k) * 3];
      if (std::isfinite(p[0]) && std::isfinite(p[1]) && p[2] > 0) person.points[k] = {p[0], p[1], std::min(p[2], 1.0F)};
    }
    people.frames[size_t(frames[row])].push_back(std::move(person));
  }
  return people;
}

}  // namespace bodyloom
