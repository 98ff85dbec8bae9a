// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/people_between.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

double MeanDistance(const DetectedPerson& a, const DetectedPerson& b) {
  double sum = 0;
  for (size_t k = 0; k < a.points.size(); ++k) {
    sum += std::hypot(a.points[k].x - b.points[k].x, a.points[k].y - b.points[k].y);
  }
  return sum / double(a.points.size());
}

double LongerSide(const DetectedPerson& person) {
  const auto by_x = [](const Keypoint& a, const Keypoint& b) { return a.x < b.x; };
  const auto by_y = [](const Keypoint& a, const Keypoint& b) { return a.y < b.y; };
  const auto [left, right] = std::minmax_element(person.points.begin(), person.points.end(), by_x);
  const auto [top, bottom] = std::minmax_element(person.points.begin(), person.points.end(), by_y);
  return std::max(right->x - left->x, bottom->y - top->y);
}

DetectedPerson PersonBetween(const DetectedPerson& before, const DetectedPerson& after, double share) {
  DetectedPerson person = before;
  person.hands_and_face = nullptr;  // they move too fast to be interpolated
  for (size_t k = 0; k < person.points.size(); ++k) {
    person.points[k] = Between(before.points[k], after.points[k], share);
  }
  return person;
}

}  // namespace

Keypoint Between(const Keypoint& before, const Keypoint& after, double share) {
  const auto blend = [share](float a, float b) { return float((1 - share) * a + share * b); };
  const bool seen = before.confidence > 0 && after.confidence > 0;
  return {blend(before.x, after.x), blend(before.y, after.y), seen ? blend(before.confidence, after.confidence) : 0};
}

void FillBetween(const std::vector<char>& detected, PeopleSequence* people) {
  BODYLOOM_CHECK(detected.size() == people->frames.size(), "FillBetween: ", detected.size(), " flags for ",
                 people->frames.size(), " frames");
  PeopleSequence seen = {people->convention, {}, {}, people->image_width, people->image_height};
  std::vector<size_t> frame_of;  // of a frame of `seen`
  for (size_t t = 0; t < detected.size(); ++t) {
    if (!detected[t]) continue;
    seen.frames.push_back(people->frames[t]);
    seen.timestamps.push_back(people->timestamps[t]);
    frame_of.push_back(t);
  }
  for (const PersonTrack& track : LinkPeople(seen)) {
    for (size_t i = 0; i + 1 < track.detections.size(); ++i) {
      const auto [from, index] = track.detections[i];
      const auto [to, next_index] = track.detections[i + 1];
      if (to != from + 1) continue;
      const DetectedPerson &before = seen.frames[size_t(from)][size_t(index)],
                           &after = seen.frames[size_t(to)][size_t(next_index)];
      const double start = seen.timestamps[size_t(from)], length = seen.timestamps[size_t(to)] - start;
      for (size_t t = frame_of[size_t(from)] + 1; t < frame_of[size_t(to)]; ++t) {
        people->frames[t].push_back(PersonBetween(before, after, (people->timestamps[t] - start) / length));
      }
    }
  }
}

double LargestStep(const std::vector<DetectedPerson>& a, const std::vector<DetectedPerson>& b) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (a.empty() || a.size() != b.size()) return kFar;
  double largest = 0;
  for (const DetectedPerson& person : a) {
    double nearest = kFar;
    for (const DetectedPerson& other : b) nearest = std::min(nearest, MeanDistance(person, other));
    largest = std::max(largest, nearest / LongerSide(person));
  }
  return largest;
}

}  // namespace bodyloom
