// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/people_npz.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/formats/ndarray.h"
#include "data_tools/observations/observations_npz.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(sizeof(Keypoint) == 3 * sizeof(float) && sizeof(Eigen::Vector3f) == 3 * sizeof(float));

/// A column of floats, one after the other.
class FloatColumn {
 public:
  template <typename T, size_t n>
  void Add(const std::array<T, n>& values) {
    const auto* first = reinterpret_cast<const float*>(values.data());
    values_.insert(values_.end(), first, first + n * sizeof(T) / sizeof(float));
  }
  void Add(float value) { values_.push_back(value); }
  [[nodiscard]] NdArray Array(const std::vector<int64_t>& shape) const {
    return NdArray::FromFloats(values_.data(), shape);
  }

 private:
  std::vector<float> values_;
};

/// Adds the arrays of hands and of faces, if there are any.
void AddHandsAndFaces(const PeopleSequence& people, NpzArrays* arrays) {
  std::vector<int32_t> hand_person, hand_side, face_person;
  FloatColumn hand_points, hand_sigma, hand_metres, face_points, face_sigma, face_depth;
  int32_t row = 0;
  for (const std::vector<DetectedPerson>& frame : people.frames) {
    for (const DetectedPerson& person : frame) {
      const HandsAndFace* found = person.hands_and_face.get();
      for (size_t side = 0; found != nullptr && side < 2; ++side) {
        if (!found->hands[side]) continue;
        hand_person.push_back(row);
        hand_side.push_back(int32_t(side));
        hand_points.Add(found->hands[side]->points);
        hand_sigma.Add(found->hands[side]->sigma_px);
        hand_metres.Add(found->hands[side]->metres);
      }
      if (found != nullptr && found->face) {
        face_person.push_back(row);
        face_points.Add(found->face->points);
        face_sigma.Add(found->face->sigma_px);
        face_depth.Add(found->face->depth_px);
      }
      ++row;
    }
  }
  if (const auto n = int64_t(hand_person.size()); n > 0) {
    (*arrays)["hand_person"] = NdArray::FromInts32(hand_person.data(), {n});
    (*arrays)["hand_side"] = NdArray::FromInts32(hand_side.data(), {n});
    (*arrays)["hand_keypoints"] = hand_points.Array({n, kHandPoints, 3});
    (*arrays)["hand_sigma_px"] = hand_sigma.Array({n, kHandPoints});
    (*arrays)["hand_metres"] = hand_metres.Array({n, kHandPoints, 3});
  }
  if (const auto n = int64_t(face_person.size()); n > 0) {
    (*arrays)["face_person"] = NdArray::FromInts32(face_person.data(), {n});
    (*arrays)["face_keypoints"] = face_points.Array({n, kFacePoints, 3});
    (*arrays)["face_sigma_px"] = face_sigma.Array({n});
    (*arrays)["face_depth_px"] = face_depth.Array({n, kFacePoints});
  }
}

/// Finite positions with a confidence above 0; it is limited to 1.
Keypoint PointAt(const float* p) {
  const bool seen = std::isfinite(p[0]) && std::isfinite(p[1]) && p[2] > 0;
  return seen ? Keypoint{p[0], p[1], std::min(p[2], 1.0F)} : Keypoint{};
}

std::vector<float> FloatsOf(const NpzArrays& arrays, const char* key, const std::vector<int64_t>& shape,
                            const std::string& where) {
  const NdArray& array = RequireArray(arrays, key, where);
  if (!array.is_number() || array.shape != shape) {
    std::string expected;
    for (const int64_t n : shape) expected += Concatenate(expected.empty() ? "" : " x ", n);
    ThrowFileError(where, key, Concatenate("shape ", array.ShapeText(), ", expected numbers, ", expected));
  }
  return array.ToFloats();
}

float SigmaAt(float value, const char* key, size_t entry, const std::string& where) {
  if (!(value >= 0) || !std::isfinite(value)) {
    ThrowFileError(where, key, Concatenate("entry ", entry, " is ", value, ", expected 0 or a positive number"));
  }
  return value;
}

/// Whole numbers of a key within 0 to `last`.
std::vector<int64_t> IndicesOf(const NpzArrays& arrays, const char* key, int64_t last, const std::string& where) {
  std::vector<int64_t> numbers = WholeNumbers(RequireArray(arrays, key, where), key, where);
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] < 0 || numbers[i] > last) {
      ThrowFileError(where, key, Concatenate("entry ", i, " is ", numbers[i], ", expected 0 to ", last));
    }
  }
  return numbers;
}

/// Gives the people, in the order of their rows, the hands and faces that the arrays hold.
void ReadHandsAndFaces(const NpzArrays& arrays, const std::string& where, PeopleSequence* people) {
  std::vector<DetectedPerson*> rows;
  for (std::vector<DetectedPerson>& frame : people->frames) {
    for (DetectedPerson& person : frame) rows.push_back(&person);
  }
  std::vector<std::shared_ptr<HandsAndFace>> found(rows.size());
  const auto of_row = [&found](int64_t row) -> HandsAndFace& {
    std::shared_ptr<HandsAndFace>& own = found[size_t(row)];
    if (!own) own = std::make_shared<HandsAndFace>();
    return *own;
  };
  const auto last_row = int64_t(rows.size()) - 1;
  if (arrays.contains("hand_person")) {
    const std::vector<int64_t> person = IndicesOf(arrays, "hand_person", last_row, where),
                               side = IndicesOf(arrays, "hand_side", 1, where);
    const auto n = int64_t(person.size());
    if (side.size() != person.size()) {
      ThrowFileError(where, "hand_side", Concatenate(side.size(), " entries, expected the ", n, " of hand_person"));
    }
    const std::vector<float> points = FloatsOf(arrays, "hand_keypoints", {n, kHandPoints, 3}, where),
                             sigma = FloatsOf(arrays, "hand_sigma_px", {n, kHandPoints}, where),
                             metres = FloatsOf(arrays, "hand_metres", {n, kHandPoints, 3}, where);
    for (size_t i = 0; i < person.size(); ++i) {
      HandObservation& hand = of_row(person[i]).hands[size_t(side[i])].emplace();
      for (size_t k = 0, at = i * kHandPoints; k < kHandPoints; ++k, ++at) {
        hand.points[k] = PointAt(&points[3 * at]);
        hand.sigma_px[k] = SigmaAt(sigma[at], "hand_sigma_px", at, where);
        hand.metres[k] = Eigen::Vector3f(&metres[3 * at]);
      }
    }
  }
  if (arrays.contains("face_person")) {
    const std::vector<int64_t> person = IndicesOf(arrays, "face_person", last_row, where);
    const auto n = int64_t(person.size());
    const std::vector<float> points = FloatsOf(arrays, "face_keypoints", {n, kFacePoints, 3}, where),
                             sigma = FloatsOf(arrays, "face_sigma_px", {n}, where),
                             depth = FloatsOf(arrays, "face_depth_px", {n, kFacePoints}, where);
    for (size_t i = 0; i < person.size(); ++i) {
      FaceObservation& face = of_row(person[i]).face.emplace();
      face.sigma_px = SigmaAt(sigma[i], "face_sigma_px", i, where);
      for (size_t k = 0, at = i * kFacePoints; k < kFacePoints; ++k, ++at) {
        face.points[k] = PointAt(&points[3 * at]);
        face.depth_px[k] = depth[at];
      }
    }
  }
  for (size_t row = 0; row < rows.size(); ++row) rows[row]->hands_and_face = std::move(found[row]);
}

}  // namespace

void WritePeople(const std::string& path, const PeopleSequence& people) {
  const size_t num_points = people.convention.names.size();
  BODYLOOM_CHECK(people.frames.size() == people.timestamps.size(), "WritePeople: ", people.frames.size(),
                 " frames and ", people.timestamps.size(), " timestamps");
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
  AddHandsAndFaces(people, &arrays);
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
  const std::vector<float> values = FloatsOf(arrays, "people_keypoints", {rows, num_points, 3}, where);
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
      person.points[size_t(k)] = PointAt(&values[size_t(row * num_points + k) * 3]);
    }
    people.frames[size_t(frames[row])].push_back(std::move(person));
  }
  ReadHandsAndFaces(arrays, where, &people);
  return people;
}

}  // namespace bodyloom
