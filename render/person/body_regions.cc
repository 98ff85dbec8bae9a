// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/person/body_regions.h"

#include <array>

namespace bodyloom {
namespace {

constexpr double kFaceBegins = 0.15, kFaceEnds = 1.4, kScalpBegins = -0.5;

int LargestInfluence(const BodyModel& body, int vertex) {
  int joint = -1;
  double largest = 0;
  for (int k = body.influence_begin()[vertex]; k < body.influence_begin()[vertex + 1]; ++k) {
    if (body.influence_weight()[k] > largest) largest = body.influence_weight()[k], joint = body.influence_joint()[k];
  }
  return joint;
}

void MarkHands(const BodyModel& body, std::vector<BodyRegion>* regions) {
  std::vector<bool> of_hand(body.num_joints(), false);
  for (const char* name : {"l_wrist", "r_wrist"}) {
    const int wrist = body.FindJoint(name);
    if (wrist >= 0) of_hand[wrist] = true;
  }
  for (int j = 1; j < body.num_joints(); ++j) of_hand[j] = of_hand[j] || of_hand[body.parents()[j]];
  for (int v = 0; v < body.num_vertices(); ++v) {
    double weight = 0;
    for (int k = body.influence_begin()[v]; k < body.influence_begin()[v + 1]; ++k) {
      if (of_hand[body.influence_joint()[k]]) weight += body.influence_weight()[k];
    }
    if (weight > 0.5) (*regions)[v] = BodyRegion::kHand;
  }
}

}  // namespace

std::vector<BodyRegion> BodyRegions(const BodyModel& body, const MatrixX3d& rest_vertices) {
  std::vector<BodyRegion> regions(body.num_vertices(), BodyRegion::kElsewhere);
  MarkHands(body, &regions);
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
  for (int v = 0; v < body.num_vertices(); ++v) {
    if (LargestInfluence(body, v) != head) continue;
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
