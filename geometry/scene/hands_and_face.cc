// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/hands_and_face.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace bodyloom {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<std::pair<int, int>> MakeFaceLines() {
  struct Curve {
    int first, last;
    bool closed;
  };
  // Jaw, brows, bridge and wings of the nose, eyes, outer and inner lips.
  constexpr Curve kCurves[] = {{0, 16, false}, {17, 21, false}, {22, 26, false}, {27, 30, false}, {31, 35, false},
                               {36, 41, true}, {42, 47, true},  {48, 59, true},  {60, 67, true}};
  std::vector<std::pair<int, int>> lines;
  for (const Curve& curve : kCurves) {
    for (int k = curve.first; k < curve.last; ++k) lines.emplace_back(k, k + 1);
    if (curve.closed) lines.emplace_back(curve.last, curve.first);
  }
  return lines;
}

}  // namespace

std::array<Eigen::Vector3f, kHandPoints> HandObservation::Unknown() {
  std::array<Eigen::Vector3f, kHandPoints> metres;
  metres.fill(Eigen::Vector3f::Constant(kNan));
  return metres;
}

std::array<float, kFacePoints> FaceObservation::Unknown() {
  std::array<float, kFacePoints> depths{};
  depths.fill(kNan);
  return depths;
}

bool HandsAndFaceSequence::empty() const {
  return std::all_of(frames.begin(), frames.end(), [](const auto& frame) { return !frame || frame->empty(); });
}

const std::array<int, kFacePoints>& Face68Of468() {
  static constexpr std::array<int, kFacePoints> kPlaces = {
      127, 234, 93,  132, 58,  136, 150, 176, 152, 400, 379, 365, 288, 361, 323, 454, 356,  // jaw
      70,  63,  105, 66,  107, 336, 296, 334, 293, 300,                                     // brows
      168, 197, 5,   4,   75,  97,  2,   326, 305,                                          // nose
      33,  160, 158, 133, 153, 144, 362, 385, 387, 263, 373, 380,                           // eyes
      61,  39,  37,  0,   267, 269, 291, 405, 314, 17,  84,  181,                           // outer lips
      78,  82,  13,  312, 308, 317, 14,  87};                                               // inner lips
  return kPlaces;
}

std::span<const std::pair<int, int>> FaceLines() {
  static const std::vector<std::pair<int, int>> lines = MakeFaceLines();
  return lines;
}

}  // namespace bodyloom
