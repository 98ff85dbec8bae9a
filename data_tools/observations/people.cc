// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/people.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "data_tools/observations/doubles.h"
#include "data_tools/observations/frame_numbers.h"
#include "geometry/base/check.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

/// A detection may lie this many body sizes from where the track was last seen, plus this many for each frame of a gap.
constexpr double kGate = 0.5;
constexpr double kGatePerMissedFrame = 0.05;
constexpr double kGateMax = 2.0;
/// A track ends after this many frames without a detection, plus some for each frame with one: spurious detections are
/// dropped soon (and cost nothing in a long clip), people who leave for a while are kept.
constexpr int kPatienceFrames = 30, kPatiencePerSeenFrame = 10;

bool IsSeen(const Keypoint& p) { return p.confidence > 0 && std::isfinite(p.x) && std::isfinite(p.y); }

struct Extent {
  double x = 0, y = 0;    ///< centre of the seen landmarks' box, px
  double diagonal = 0;    ///< px
  double confidence = 0;  ///< mean of the seen landmarks
  int count = 0;
};

Extent ExtentOf(const DetectedPerson& person) {
  float x0 = std::numeric_limits<float>::max(), y0 = x0, x1 = -x0, y1 = -x0;
  Extent extent;
  for (const Keypoint& p : person.points) {
    if (!IsSeen(p)) continue;
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    extent.confidence += std::min(1.0F, p.confidence);
    ++extent.count;
  }
  if (extent.count == 0) return extent;
  extent.confidence /= extent.count;
  extent.x = 0.5 * (double{x0} + x1);
  extent.y = 0.5 * (double{y0} + y1);
  extent.diagonal = std::hypot(double{x1} - x0, double{y1} - y0);
  return extent;
}

/// A track while it is being built.
struct OpenTrack {
  PersonTrack track;
  const DetectedPerson* last = nullptr;
  Extent last_extent;
  double size = 0;  ///< slowly forgetting maximum of the diagonal, px
  int last_frame = -1;
  int seen_frames = 0;
  int identity = -1;

  [[nodiscard]] bool IsGivenUp(int frame) const {
    return frame - last_frame > kPatienceFrames + kPatiencePerSeenFrame * seen_frames;
  }
};

/// Distance in body sizes between a detection and where the track was last seen.
double RelativeDistance(const OpenTrack& track, const DetectedPerson& person, const Extent& extent) {
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < person.points.size(); ++k) {
    const Keypoint &a = track.last->points[k], &b = person.points[k];
    if (!IsSeen(a) || !IsSeen(b)) continue;
    sum += std::hypot(double{a.x} - b.x, double{a.y} - b.y);
    ++count;
  }
  const double distance =
      count > 0 ? sum / count : std::hypot(track.last_extent.x - extent.x, track.last_extent.y - extent.y);
  return distance / std::max(1.0, std::max(track.size, extent.diagonal));
}

void Extend(OpenTrack* track, int frame, int index, const DetectedPerson& person, const Extent& extent) {
  track->track.detections.emplace_back(frame, index);
  track->track.weight += extent.diagonal * extent.confidence;
  track->last = &person;
  track->last_extent = extent;
  track->size = std::max(extent.diagonal, 0.98 * track->size);
  track->last_frame = frame;
  ++track->seen_frames;
  track->identity = person.identity;
}

}  // namespace

Keypoint DetectedKeypoint(double x, double y, double confidence) {
  const Keypoint point{static_cast<float>(x), static_cast<float>(y), static_cast<float>(confidence)};
  const bool is_finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.confidence);
  return is_finite ? point : Keypoint{};
}

PeopleSequence PeopleOnGrid(std::vector<std::vector<DetectedPerson>> frames, const std::vector<int64_t>& numbers,
                            const KeypointConvention* convention, double fps, const std::string& where) {
  PeopleSequence people;
  people.convention = convention != nullptr ? *convention : Coco17();
  FrameGrid grid = MakeFrameGrid(numbers, fps, where);
  people.timestamps = std::move(grid.timestamps);
  people.frames.resize(people.timestamps.size());
  for (size_t i = 0; i < frames.size(); ++i) people.frames[size_t(grid.index[i])] = std::move(frames[i]);
  return people;
}

std::vector<PersonTrack> LinkPeople(const PeopleSequence& people) {
  const int num_frames = static_cast<int>(people.frames.size());
  bool has_identities = true;
  for (const auto& frame : people.frames) {
    for (const DetectedPerson& person : frame) has_identities &= person.identity >= 0;
  }
  std::vector<OpenTrack> tracks;  // still open
  std::vector<PersonTrack> result;
  for (int t = 0; t < num_frames; ++t) {
    const auto& detections = people.frames[t];
    if (!has_identities) {
      for (OpenTrack& track : tracks) {
        if (track.IsGivenUp(t)) result.push_back(std::move(track.track));
      }
      std::erase_if(tracks, [t](const OpenTrack& track) { return track.IsGivenUp(t); });
    }
    std::vector<Extent> extents(detections.size());
    std::vector<std::tuple<double, size_t, size_t>> pairs;  // distance, track, detection
    for (size_t d = 0; d < detections.size(); ++d) {
      extents[d] = ExtentOf(detections[d]);
      if (extents[d].count == 0) continue;
      for (size_t k = 0; k < tracks.size(); ++k) {
        if (has_identities) {
          if (tracks[k].identity == detections[d].identity) pairs.emplace_back(0.0, k, d);
          continue;
        }
        const double gate = std::min(kGateMax, kGate + kGatePerMissedFrame * (t - tracks[k].last_frame - 1));
        const double distance = RelativeDistance(tracks[k], detections[d], extents[d]);
        if (distance < gate) pairs.emplace_back(distance, k, d);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> taken(detections.size(), false);
    for (const auto& [distance, k, d] : pairs) {
      if (taken[d] || tracks[k].last_frame == t) continue;
      taken[d] = true;
      Extend(&tracks[k], t, static_cast<int>(d), detections[d], extents[d]);
    }
    for (size_t d = 0; d < detections.size(); ++d) {
      if (taken[d] || extents[d].count == 0) continue;
      OpenTrack track;
      Extend(&track, t, static_cast<int>(d), detections[d], extents[d]);
      tracks.push_back(std::move(track));
    }
  }
  for (OpenTrack& track : tracks) result.push_back(std::move(track.track));
  result = JoinDoubles(people, std::move(result));
  std::stable_sort(result.begin(), result.end(),
                   [](const PersonTrack& a, const PersonTrack& b) { return a.weight > b.weight; });
  return result;
}

PersonTrack PersonOf(const PeopleSequence& people, int person, const std::string& where) {
  BODYLOOM_CHECK(person >= 0, "person ", person, " must not be negative");
  const std::vector<PersonTrack> tracks = LinkPeople(people);
  if (tracks.empty()) {
    throw NoPersonFound(where + ": no person in any of " + std::to_string(people.frames.size()) + " frames");
  }
  if (person >= static_cast<int>(tracks.size())) {
    throw std::runtime_error(where + ": person " + std::to_string(person) + " requested, but only " +
                             std::to_string(tracks.size()) + " were found (0 is the largest)");
  }
  return tracks[person];
}

KeypointSequence KeypointsOf(const PeopleSequence& people, const PersonTrack& person) {
  KeypointSequence sequence;
  sequence.convention = people.convention.name;
  sequence.names = people.convention.names;
  sequence.timestamps = people.timestamps;
  sequence.image_width = people.image_width;
  sequence.image_height = people.image_height;
  sequence.points.resize(people.frames.size() * sequence.names.size());
  for (const auto& [t, index] : person.detections) {
    for (int k = 0; k < sequence.num_points(); ++k) {
      const Keypoint& p = people.frames[t][index].points[k];
      if (IsSeen(p)) sequence.at(t, k) = {p.x, p.y, std::min(1.0F, p.confidence)};
    }
  }
  return sequence;
}

HandsAndFaceSequence HandsAndFaceOf(const PeopleSequence& people, const PersonTrack& person) {
  HandsAndFaceSequence sequence;
  sequence.frames.resize(people.frames.size());
  sequence.timestamps = people.timestamps;
  sequence.image_width = people.image_width;
  sequence.image_height = people.image_height;
  for (const auto& [t, index] : person.detections) {
    sequence.frames[size_t(t)] = people.frames[size_t(t)][size_t(index)].hands_and_face;
  }
  return sequence;
}

KeypointSequence SelectPerson(const PeopleSequence& people, int person, const std::string& where) {
  return KeypointsOf(people, PersonOf(people, person, where));
}

}  // namespace bodyloom
