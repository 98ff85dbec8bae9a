// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/people.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>

#include "data_tools/observations/frame_numbers.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr float kCounts = 0.3F;  ///< confidence
constexpr int kFewestJoints = 5;
constexpr double kOverlap = 0.6;                          ///< of the smaller box's area
constexpr double kDoubleDistance = 0.08;                  ///< body sizes
constexpr double kInsideDistance = 0.04, kAround = 0.06;  ///< body sizes, of the shorter's joints and the longer's
constexpr double kSameSize = 0.75;                        ///< of the smaller body, in sizes of the larger
constexpr double kMostFrames = 0.5;                       ///< of those in which the shorter is seen
constexpr int kFewestInside = 8;                          ///< frames

constexpr std::array<std::pair<const char*, const char*>, 14> kLimbs = {{{"nose", "left_shoulder"},
                                                                         {"nose", "right_shoulder"},
                                                                         {"left_shoulder", "right_shoulder"},
                                                                         {"left_shoulder", "left_elbow"},
                                                                         {"left_elbow", "left_wrist"},
                                                                         {"right_shoulder", "right_elbow"},
                                                                         {"right_elbow", "right_wrist"},
                                                                         {"left_shoulder", "left_hip"},
                                                                         {"right_shoulder", "right_hip"},
                                                                         {"left_hip", "right_hip"},
                                                                         {"left_hip", "left_knee"},
                                                                         {"left_knee", "left_ankle"},
                                                                         {"right_hip", "right_knee"},
                                                                         {"right_knee", "right_ankle"}}};

bool Counts(const Keypoint& p) { return p.confidence >= kCounts && std::isfinite(p.x) && std::isfinite(p.y); }

Eigen::Vector2d PixelOf(const Keypoint& p) { return {p.x, p.y}; }

/// Box around the landmarks that count.
struct CountedBox {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e30), high = Eigen::Array2d::Constant(-1e30);
  int count = 0;

  explicit CountedBox(const DetectedPerson& person) {
    for (const Keypoint& p : person.points) {
      if (!Counts(p)) continue;
      low = low.min(PixelOf(p).array());
      high = high.max(PixelOf(p).array());
      ++count;
    }
  }
  [[nodiscard]] double Diagonal() const { return (high - low).matrix().norm(); }
  [[nodiscard]] double Area() const { return (high - low).prod(); }
  [[nodiscard]] bool Covers(const CountedBox& other) const {
    const Eigen::Array2d shared = (high.min(other.high) - low.max(other.low)).max(0);
    return shared.prod() > kOverlap * std::min(Area(), other.Area());
  }
};

enum class Relation { kApart, kInside, kDouble };

/// Compares two people of one frame.
class BodyComparison {
 public:
  explicit BodyComparison(const KeypointConvention& convention) {
    const std::vector<std::string>& names = convention.names;
    const auto index_of = [&names](const std::string& name) {
      const auto found = std::find(names.begin(), names.end(), name);
      return found == names.end() ? -1 : int(found - names.begin());
    };
    for (size_t k = 0; k < names.size(); ++k) {
      const bool left = names[k].starts_with("left_"), right = names[k].starts_with("right_");
      const int other = left    ? index_of("right_" + names[k].substr(5))
                        : right ? index_of("left_" + names[k].substr(6))
                                : -1;
      exchanged_.push_back(other >= 0 ? size_t(other) : k);
    }
    for (const auto& [from, to] : kLimbs) {
      const int a = index_of(from), b = index_of(to);
      if (a >= 0 && b >= 0) limbs_.emplace_back(a, b);
      for (const int joint : {a, b}) {
        if (joint >= 0 && std::find(joints_.begin(), joints_.end(), joint) == joints_.end()) joints_.push_back(joint);
      }
    }
  }

  [[nodiscard]] Relation Compare(const DetectedPerson& shorter, const CountedBox& shorter_box,
                                 const DetectedPerson& longer, const CountedBox& longer_box) const {
    if (std::min(shorter_box.count, longer_box.count) < kFewestJoints || !shorter_box.Covers(longer_box)) {
      return Relation::kApart;
    }
    const double size = std::max(shorter_box.Diagonal(), longer_box.Diagonal());
    if (DistanceByName(shorter, longer) < kDoubleDistance * size) return Relation::kDouble;
    return DistanceToLimbs(shorter, longer) < kInsideDistance * size &&
                   DistanceToLimbs(longer, shorter) < kAround * size
               ? Relation::kInside
               : Relation::kApart;
  }

 private:
  /// Mean distance of the landmarks that count in both, pixels, as named or exchanged, whichever is smaller; infinite
  /// with too few.
  [[nodiscard]] double DistanceByName(const DetectedPerson& a, const DetectedPerson& b) const {
    double smaller = std::numeric_limits<double>::infinity();
    for (const bool exchanged : {false, true}) {
      double sum = 0;
      int count = 0;
      for (size_t k = 0; k < a.points.size(); ++k) {
        const Keypoint &p = a.points[k], &q = b.points[exchanged ? exchanged_[k] : k];
        if (!Counts(p) || !Counts(q)) continue;
        sum += (PixelOf(p) - PixelOf(q)).norm();
        ++count;
      }
      if (count >= kFewestJoints) smaller = std::min(smaller, sum / count);
    }
    return smaller;
  }

  /// Mean distance of a's joints to the nearest limb of b, pixels; infinite with too few joints or no limb.
  [[nodiscard]] double DistanceToLimbs(const DetectedPerson& a, const DetectedPerson& b) const {
    double sum = 0;
    int count = 0;
    for (const int joint : joints_) {
      if (!Counts(a.points[size_t(joint)])) continue;
      const Eigen::Vector2d p = PixelOf(a.points[size_t(joint)]);
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& [from, to] : limbs_) {
        if (!Counts(b.points[size_t(from)]) || !Counts(b.points[size_t(to)])) continue;
        const Eigen::Vector2d start = PixelOf(b.points[size_t(from)]), along = PixelOf(b.points[size_t(to)]) - start;
        const double at = std::clamp(along.dot(p - start) / std::max(1e-9, along.squaredNorm()), 0.0, 1.0);
        nearest = std::min(nearest, (p - start - at * along).norm());
      }
      sum += nearest;
      ++count;
    }
    return count < kFewestJoints ? std::numeric_limits<double>::infinity() : sum / count;
  }

  std::vector<size_t> exchanged_;           ///< the landmark of the other side
  std::vector<std::pair<int, int>> limbs_;  ///< landmarks at their ends
  std::vector<int> joints_;
};

/// Numbers of frames in which the shorter of two tracks is a double of the longer, or inside it.
struct SharedFrames {
  int doubles = 0, inside = 0;
  [[nodiscard]] bool AreDoubles(size_t seen) const { return doubles >= kMostFrames * double(seen); }
  [[nodiscard]] bool AreOneBody(size_t seen) const {
    return AreDoubles(seen) || (int(seen) >= kFewestInside && doubles + inside >= kMostFrames * double(seen));
  }
};

/// By (shorter, longer) track, of the pairs that share a body in any frame.
std::map<std::pair<size_t, size_t>, SharedFrames> CompareTracks(const PeopleSequence& people,
                                                                const std::vector<PersonTrack>& tracks) {
  std::vector<std::vector<std::pair<size_t, int>>> seen(people.frames.size());  // of each frame: track, index
  for (size_t i = 0; i < tracks.size(); ++i) {
    for (const auto& [frame, index] : tracks[i].detections) seen[size_t(frame)].emplace_back(i, index);
  }
  const BodyComparison comparison(people.convention);
  std::map<std::pair<size_t, size_t>, SharedFrames> shared;
  for (size_t t = 0; t < seen.size(); ++t) {
    if (seen[t].size() < 2) continue;
    std::vector<CountedBox> boxes;
    for (const auto& [track, index] : seen[t]) boxes.emplace_back(people.frames[t][size_t(index)]);
    for (size_t i = 0; i < seen[t].size(); ++i) {
      for (size_t j = i + 1; j < seen[t].size(); ++j) {
        const size_t length_i = tracks[seen[t][i].first].detections.size();
        const size_t length_j = tracks[seen[t][j].first].detections.size();
        const auto [s, l] = length_i < length_j ? std::pair(i, j) : std::pair(j, i);
        const Relation relation = comparison.Compare(people.frames[t][size_t(seen[t][s].second)], boxes[s],
                                                     people.frames[t][size_t(seen[t][l].second)], boxes[l]);
        if (relation == Relation::kApart) continue;
        SharedFrames& frames = shared[{seen[t][s].first, seen[t][l].first}];
        ++(relation == Relation::kDouble ? frames.doubles : frames.inside);
      }
    }
  }
  return shared;
}

/// Adds the detections of `from` in frames where `to` has none.
void TakeMissing(const PersonTrack& from, PersonTrack* to) {
  const auto by_frame = [](const auto& a, const auto& b) { return a.first < b.first; };
  const size_t before = to->detections.size();
  std::vector<std::pair<int, int>> all;
  std::set_union(to->detections.begin(), to->detections.end(), from.detections.begin(), from.detections.end(),
                 std::back_inserter(all), by_frame);  // of equal frames the first range's
  to->detections = std::move(all);
  to->weight += from.weight * double(to->detections.size() - before) / double(from.detections.size());
}

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

std::vector<PersonTrack> JoinDoubles(const PeopleSequence& people, std::vector<PersonTrack> tracks) {
  std::map<size_t, std::pair<size_t, SharedFrames>> body_of;  // of a track that ends: the longer one
  for (const auto& [pair, frames] : CompareTracks(people, tracks)) {
    const auto& [shorter, longer] = pair;
    if (!frames.AreOneBody(tracks[shorter].detections.size())) continue;
    const auto [found, is_new] = body_of.try_emplace(shorter, longer, frames);
    if (!is_new && frames.doubles + frames.inside > found->second.second.doubles + found->second.second.inside) {
      found->second = {longer, frames};
    }
  }
  std::vector<size_t> ending;  // the longest first, as their detections come first
  for (const auto& [track, body] : body_of) ending.push_back(track);
  std::vector<size_t> lengths;
  for (const PersonTrack& track : tracks) lengths.push_back(track.detections.size());
  std::stable_sort(ending.begin(), ending.end(), [&](size_t a, size_t b) { return lengths[a] > lengths[b]; });
  for (const size_t track : ending) {
    size_t body = track;
    bool are_doubles = true;  // along the chain of longer tracks
    for (auto at = body_of.find(body); at != body_of.end(); at = body_of.find(body)) {
      are_doubles = are_doubles && at->second.second.AreDoubles(lengths[body]);
      body = at->second.first;
    }
    if (are_doubles) TakeMissing(tracks[track], &tracks[body]);
    ++tracks[body].joined;
  }
  std::vector<PersonTrack> left;
  for (size_t i = 0; i < tracks.size(); ++i) {
    if (!body_of.contains(i)) left.push_back(std::move(tracks[i]));
  }
  return left;
}

}  // namespace bodyloom
