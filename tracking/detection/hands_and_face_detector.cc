// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/hands_and_face_detector.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "tracking/detection/face_landmarks.h"
#include "tracking/detection/hand_landmarks.h"

namespace bodyloom {
namespace {

constexpr double kMinVisibility = 0.1;
constexpr double kHandOfSide = 1.0 / 3;   ///< wrist to middle knuckle, relative to a region's side
constexpr double kSameHand = 0.5;         ///< mean distance of two hands' points, in those lengths
constexpr int kFirstOfHand[] = {15, 16};  ///< MediaPipe33()'s wrists; little finger and index follow two by two
constexpr size_t kFacePointsOfBody = 11;  ///< its first ones

enum class Fate { kFound, kHidden, kSmall, kAbsent, kElsewhere };

/// One hand of one person in one frame.
struct HandSeen {
  Fate fate = Fate::kAbsent;
  DetectedHand first, last;
  double offset = 0;  ///< of its wrist from the body's, in lengths of the hand
};

struct FaceSeen {
  Fate fate = Fate::kAbsent;
  DetectedFace face;
};

struct PersonSeen {
  std::array<HandSeen, 2> hands;
  FaceSeen face;
};

void Count(Fate fate, PartCounts* counts) {
  ++counts->parts;
  ++(fate == Fate::kFound    ? counts->found
     : fate == Fate::kHidden ? counts->hidden
     : fate == Fate::kSmall  ? counts->small
     : fate == Fate::kAbsent ? counts->absent
                             : counts->elsewhere);
}

/// Of two hands at one place the one farther from its wrist is elsewhere.
void DropDouble(std::array<HandSeen, 2>* hands) {
  auto& [left, right] = *hands;
  if (left.fate != Fate::kFound || right.fate != Fate::kFound) return;
  double distance = 0;
  for (size_t k = 0; k < kHandPoints; ++k) distance += (left.last.points[k] - right.last.points[k]).norm();
  const double length = kHandOfSide * std::max(left.last.region.side, right.last.region.side);
  if (distance / kHandPoints >= kSameHand * length) return;
  (left.offset > right.offset ? left : right).fate = Fate::kElsewhere;
}

std::string PartsText(const char* name, const PartCounts& counts) {
  std::string text = Concatenate(name, counts.found, " of ", counts.parts, " found");
  const std::pair<const char*, int> reasons[] = {{"hidden", counts.hidden},
                                                 {"too small", counts.small},
                                                 {"not seen by the network", counts.absent},
                                                 {"at the other hand's place", counts.elsewhere}};
  const char* before = "; ";
  for (const auto& [reason, count] : reasons) {
    if (count == 0) continue;
    text += Concatenate(before, count, " ", reason);
    before = ", ";
  }
  return text + "\n";
}

}  // namespace

std::string ToText(HandsAndFaceChoice choice) {
  constexpr const char* kNames[] = {"off", "auto", "on"};
  return kNames[static_cast<size_t>(choice)];
}

HandsAndFaceChoice HandsAndFaceChoiceNamed(const std::string& name) {
  for (const auto choice : {HandsAndFaceChoice::kOff, HandsAndFaceChoice::kAuto, HandsAndFaceChoice::kOn}) {
    if (ToText(choice) == name) return choice;
  }
  throw std::invalid_argument("hands: \"" + name + "\", expected off, auto or on");
}

std::string ToText(const HandsAndFaceSummary& summary) {
  if (!summary.why_not.empty()) return "hands    not looked for: " + summary.why_not + "\n";
  if (summary.hands.parts == 0) return "";
  return PartsText("hands    ", summary.hands) + PartsText("faces    ", summary.faces);
}

class HandsAndFaceDetector::Networks {
 public:
  explicit Networks(const std::string& folder) : hands_(folder), faces_(folder) {}

  [[nodiscard]] HandSeen HandOfBody(const Image& image, const DetectedPose& pose, int side,
                                    const HandsAndFaceOptions& options) const {
    const auto at = [&](int offset) -> const PoseLandmark& {
      return pose.landmarks[size_t(kFirstOfHand[side] + offset)];
    };
    HandSeen hand;
    const PoseRegion of_body = HandRegionOfBody(at(0).pixel, at(2).pixel, at(4).pixel);
    hand.fate = Fate::kHidden;
    if (!(at(0).visibility >= kMinVisibility) || !of_body.IsValid()) return hand;
    hand.fate = Fate::kSmall;
    if (of_body.side < options.min_side_px) return hand;
    const std::optional<PoseRegion> narrowed = hands_.Narrowed(image, of_body);
    if (!narrowed || narrowed->side < options.min_side_px) return hand;
    hand.fate = Fate::kAbsent;
    hand.first = hands_.HandIn(image, *narrowed);
    const PoseRegion region = HandRegionOfPoints(hand.first.points);
    if (!region.IsValid()) return hand;
    hand.last = hands_.HandIn(image, region);
    if (!(hand.last.presence >= options.min_presence)) return hand;
    hand.offset = (hand.last.points[0] - at(0).pixel).norm() / (kHandOfSide * region.side);
    hand.fate = hand.offset <= 1 ? Fate::kFound : Fate::kElsewhere;
    return hand;
  }

  [[nodiscard]] FaceSeen FaceOfBody(const Image& image, const DetectedPose& pose,
                                    const HandsAndFaceOptions& options) const {
    std::array<Eigen::Vector2d, kFacePointsOfBody> points;
    for (size_t k = 0; k < points.size(); ++k) points[k] = pose.landmarks[k].pixel;
    FaceSeen seen;
    seen.fate = Fate::kSmall;
    const PoseRegion of_body = FaceRegionOfBody(points);
    if (!of_body.IsValid() || of_body.side < options.min_side_px) return seen;
    seen.fate = Fate::kAbsent;
    const PoseRegion region = FaceRegionOfPoints(faces_.FaceIn(image, of_body).points);
    if (!region.IsValid()) return seen;
    seen.face = faces_.FaceIn(image, region);
    if (seen.face.presence >= options.min_presence) seen.fate = Fate::kFound;
    return seen;
  }

 private:
  HandDetector hands_;
  FaceDetector faces_;
};

HandsAndFaceDetector::HandsAndFaceDetector(const std::string& folder, const HandsAndFaceOptions& options)
    : networks_(std::make_unique<const Networks>(folder)), options_(options) {}
HandsAndFaceDetector::~HandsAndFaceDetector() = default;

std::vector<std::vector<std::shared_ptr<const HandsAndFace>>> HandsAndFaceDetector::Detect(
    std::span<const Image> frames, std::span<const std::vector<DetectedPose>> people) {
  BODYLOOM_CHECK(frames.size() == people.size(), "hands and faces: ", frames.size(), " images and people of ",
                 people.size());
  const Stopwatch watch;
  std::vector<std::vector<PersonSeen>> seen(frames.size());
  struct Task {
    size_t frame, person;
    int part;  ///< left hand, right hand, face
  };
  std::vector<Task> tasks;
  for (size_t f = 0; f < frames.size(); ++f) {
    seen[f].resize(people[f].size());
    for (size_t person = 0; person < people[f].size(); ++person) {
      for (int part = 0; part < 3; ++part) tasks.push_back({f, person, part});
    }
  }
  ParallelFor(int(tasks.size()), options_.num_threads, [&](int i) {
    const auto [f, person, part] = tasks[size_t(i)];
    const DetectedPose& pose = people[f][person];
    if (part == 2) {
      seen[f][person].face = networks_->FaceOfBody(frames[f], pose, options_);
    } else {
      seen[f][person].hands[size_t(part)] = networks_->HandOfBody(frames[f], pose, part, options_);
    }
  });
  std::vector<std::vector<std::shared_ptr<const HandsAndFace>>> result(frames.size());
  for (size_t f = 0; f < frames.size(); ++f) {
    for (PersonSeen& person : seen[f]) {
      DropDouble(&person.hands);
      auto found = std::make_shared<HandsAndFace>();
      for (size_t side = 0; side < 2; ++side) {
        const HandSeen& hand = person.hands[side];
        Count(hand.fate, &summary_.hands);
        if (hand.fate == Fate::kFound) found->hands[side] = HandOf(hand.first, hand.last);
      }
      Count(person.face.fate, &summary_.faces);
      if (person.face.fate == Fate::kFound) found->face = FaceOf(person.face.face);
      result[f].push_back(found->empty() ? nullptr : std::move(found));
    }
  }
  summary_.seconds += watch.seconds();
  return result;
}

}  // namespace bodyloom
