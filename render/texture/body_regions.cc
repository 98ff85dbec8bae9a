// SPDX-License-Identifier: Apache-2.0
#include "render/texture/body_regions.h"

#include <array>

#include "geometry/body/skinning.h"

namespace bodyloom {
namespace {

constexpr double kFaceBegins = 0.15, kFaceEnds = 1.4, kScalpBegins = -0.5;

}  // namespace

std::vector<BodyRegion> BodyRegions(const BodyModel& body, const MatrixX3d& rest_vertices) {
  std::vector<BodyRegion> regions(body.num_vertices(), BodyRegion::kElsewhere);
  const std::vector<double> of_hands = WeightsBelow(body, {"l_wrist", "r_wrist"});
  for (int v = 0; v < body.num_vertices(); ++v) {
    if (of_hands[v] > 0.5) regions[v] = BodyRegion::kHand;
  }
  const int head = body.FindJoint("head");
  constexpr std::array kNames = {"nose", "left_eye", "right_eye", "left_ear", "right_ear"};
  std::array<Eigen::Vector3d, kNames.size()> points;
  for (size_t i = 0; i < kNames.size(); ++i) {
    const int found = body.FindLandmark(kNames[i]);
    if (found < 0 || head < 0) return regions;
    const Landmark& landmark = body.data().landmarks[found];
    points[i].setZero();
    for (size_t k = 0; k < landmark.vertices.size(); ++k) {
      points[i] += landmark.weights[k] * rest_vertices.row(landmark.vertices[k]).transpose();
    }
  }
  const Eigen::Vector3d &nose = points[0], eyes = (points[1] + points[2]) / 2, ears = (points[3] + points[4]) / 2;
  const double unit = eyes.y() - nose.y();
  const std::vector<int> strongest = StrongestJoints(body);
  for (int v = 0; v < body.num_vertices(); ++v) {
    if (strongest[v] != head) continue;
    const double y = rest_vertices(v, 1), z = rest_vertices(v, 2);
    if (z > ears.z() + kFaceBegins * (nose.z() - ears.z()) && y < eyes.y() + kFaceEnds * unit) {
      regions[v] = BodyRegion::kFace;
    } else if (y > nose.y() + kScalpBegins * unit) {
      regions[v] = BodyRegion::kScalp;
    }
  }
  return regions;
}

}  // namespace bodyloom
