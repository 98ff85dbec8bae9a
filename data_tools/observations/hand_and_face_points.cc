// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/hand_and_face_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "data_tools/observations/people.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr size_t kOpenPoseFace = 70, kMediaPipeFace = 468, kMediaPipeFaceWithIrises = 478;

Keypoint Limited(Keypoint point) {
  if (!(point.confidence > 0) || !std::isfinite(point.x) || !std::isfinite(point.y)) return {};
  point.confidence = std::min(point.confidence, 1.0F);
  return point;
}

bool AnySeen(std::span<const Keypoint> points) {
  return std::any_of(points.begin(), points.end(), [](const Keypoint& p) { return p.confidence > 0; });
}

std::optional<HandObservation> Hand(const std::vector<Keypoint>& points, const char* which, const std::string& place) {
  if (points.empty()) return std::nullopt;
  if (points.size() != kHandPoints) {
    ThrowFileError(place, Concatenate(points.size(), " points of the ", which, " hand, expected ", kHandPoints));
  }
  HandObservation hand;
  std::transform(points.begin(), points.end(), hand.points.begin(), Limited);
  return AnySeen(hand.points) ? std::optional(hand) : std::nullopt;
}

std::optional<FaceObservation> Face(const std::vector<Keypoint>& points, const std::string& place) {
  const size_t n = points.size();
  if (n == 0) return std::nullopt;
  const bool is_mediapipe = n == kMediaPipeFace || n == kMediaPipeFaceWithIrises;
  if (!is_mediapipe && n != kFacePoints && n != kOpenPoseFace) {
    ThrowFileError(place, Concatenate(n, " points of the face, expected ", kFacePoints, ", ", kOpenPoseFace, ", ",
                                      kMediaPipeFace, " or ", kMediaPipeFaceWithIrises));
  }
  FaceObservation face;
  for (size_t k = 0; k < kFacePoints; ++k) {
    face.points[k] = Limited(points[is_mediapipe ? size_t(Face68Of468()[k]) : k]);
  }
  return AnySeen(face.points) ? std::optional(face) : std::nullopt;
}

}  // namespace

std::shared_ptr<const HandsAndFace> HandsAndFaceFrom(const HandAndFacePoints& points, const std::string& place) {
  HandsAndFace found;
  found.hands[HandsAndFace::kLeft] = Hand(points.left_hand, "left", place);
  found.hands[HandsAndFace::kRight] = Hand(points.right_hand, "right", place);
  found.face = Face(points.face, place);
  return found.empty() ? nullptr : std::make_shared<const HandsAndFace>(std::move(found));
}

std::shared_ptr<const HandsAndFace> HandsAndFaceOfWholeBody(std::span<const Keypoint> all, size_t num_body,
                                                            const std::string& place) {
  constexpr size_t kHand = kHandPoints, kFace = kFacePoints;
  if (all.size() != num_body + kFace + 2 * kHand) return nullptr;
  const auto part = [&](size_t first, size_t count) {
    const auto points = all.subspan(num_body + first, count);
    return std::vector<Keypoint>(points.begin(), points.end());
  };
  return HandsAndFaceFrom({part(kFace, kHand), part(kFace + kHand, kHand), part(0, kFace)}, place);
}

void ChangeHandsAndFaces(const std::function<void(HandsAndFace*)>& change, HandsAndFaceSequence* sequence) {
  for (std::shared_ptr<const HandsAndFace>& frame : sequence->frames) {
    if (!frame) continue;
    auto changed = std::make_shared<HandsAndFace>(*frame);
    change(changed.get());
    frame = std::move(changed);
  }
}

std::vector<Keypoint> PointsAtKey(const JsonNode& table, const char* key) {
  if (!table.Has(key) || table.At(key).is_null()) return {};
  const std::vector<double> numbers = table.At(key).NumbersOrNan();
  if (numbers.size() % 3 != 0) {
    ThrowFileError(table.At(key).place(),
                   Concatenate(numbers.size(), " numbers, expected a multiple of 3 (x, y, confidence)"));
  }
  std::vector<Keypoint> points;
  for (size_t i = 0; i < numbers.size(); i += 3) {
    points.push_back(DetectedKeypoint(numbers[i], numbers[i + 1], numbers[i + 2]));
  }
  return points;
}

}  // namespace bodyloom
