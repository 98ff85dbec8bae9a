// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/body_obstacles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/body/skinning.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

enum class Limb { kTrunk, kHips, kLeg, kArm };
struct BoneOfLimb {
  int from, to;
  Limb limb;
};

/// SMPL's joints. Hips and shoulders are joined across, because a trunk is wide.
constexpr std::array<BoneOfLimb, 16> kBones = {{{0, 3, Limb::kTrunk},
                                                {3, 6, Limb::kTrunk},
                                                {6, 12, Limb::kTrunk},
                                                {1, 2, Limb::kHips},
                                                {1, 4, Limb::kLeg},
                                                {2, 5, Limb::kLeg},
                                                {4, 7, Limb::kLeg},
                                                {5, 8, Limb::kLeg},
                                                {7, 10, Limb::kLeg},
                                                {8, 11, Limb::kLeg},
                                                {16, 18, Limb::kArm},
                                                {17, 19, Limb::kArm},
                                                {18, 20, Limb::kArm},
                                                {19, 21, Limb::kArm},
                                                {20, 22, Limb::kArm},
                                                {21, 23, Limb::kArm}}};

bool IsBelowWaist(int joint) { return joint == 0 || (IsOfTrunkOrLegs(joint) && joint % 3 != 0); }

ClothSide SideOf(Limb limb) {
  if (limb == Limb::kTrunk) return ClothSide::kAnywhere;
  return limb == Limb::kArm ? ClothSide::kOutside : ClothSide::kInside;
}

/// Mean of the distances; for the trunk, which is not a tube, the first decile.
double RadiusOf(std::vector<double> distances, Limb limb) {
  if (distances.empty()) return 0;
  std::sort(distances.begin(), distances.end());
  if (limb == Limb::kTrunk || limb == Limb::kHips) return 0.8 * distances[distances.size() / 10];
  double sum = 0;
  for (const double d : distances) sum += d;
  return (limb == Limb::kLeg ? 0.85 : 1.0) * sum / double(distances.size());
}

}  // namespace

BodyObstacles::BodyObstacles(const BodyModel& body, const MatrixX3d& vertices, const MatrixX3d& joints) {
  const std::vector<int> strongest = StrongestJoints(body);
  std::vector<int> place(body.num_vertices(), -1);
  for (int v = 0; v < body.num_vertices(); ++v) {
    if (!IsOfTrunkOrLegs(strongest[v])) continue;
    place[v] = static_cast<int>(vertices_.size());
    vertices_.push_back(v);
    belongs_.push_back(IsBelowWaist(strongest[v]) ? ClothSide::kInside : ClothSide::kAnywhere);
  }
  const MatrixX3i& faces = body.data().faces;
  std::vector<int> kept;
  for (int f = 0; f < faces.rows(); ++f) {
    if (place[faces(f, 0)] >= 0 && place[faces(f, 1)] >= 0 && place[faces(f, 2)] >= 0) kept.push_back(f);
  }
  faces_.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (size_t i = 0; i < kept.size(); ++i) {
    for (int c = 0; c < 3; ++c) faces_(static_cast<Eigen::Index>(i), c) = place[faces(kept[i], c)];
  }
  for (BoneOfLimb bone : kBones) {
    // The hand of a body with fingers ends at its middle knuckle.
    if (const int knuckle = body.FindJoint(bone.from == 20 ? "l_middle1" : "r_middle1");
        knuckle >= 0 && (bone.from == 20 || bone.from == 21)) {
      bone.to = knuckle;
    }
    const Capsule axis = {joints.row(bone.from).transpose(), joints.row(bone.to).transpose(), 0, 0};
    std::array<std::vector<double>, 2> distances;
    for (int v = 0; v < body.num_vertices(); ++v) {
      if (strongest[v] != bone.from && strongest[v] != bone.to) continue;
      Vector3d away;
      double along;
      const double distance = CapsuleDistance(axis, vertices.row(v).transpose(), &away, &along);
      if (along > 0 && along < 1) distances[along < 0.5 ? 0 : 1].push_back(distance);
    }
    bones_.push_back({bone.from, bone.to, RadiusOf(distances[0], bone.limb), RadiusOf(distances[1], bone.limb),
                      bone.limb == Limb::kArm, SideOf(bone.limb)});
  }
}

ClothObstacles BodyObstacles::At(const MatrixX3d& vertices, const MatrixX3f& normals, const MatrixX3d& joints) const {
  ClothObstacles obstacles;
  obstacles.belongs = belongs_;
  const auto n = static_cast<Eigen::Index>(vertices_.size());
  obstacles.points.resize(n, 3), obstacles.normals.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    obstacles.points.row(i) = vertices.row(vertices_[i]);
    obstacles.normals.row(i) = normals.row(vertices_[i]);
  }
  for (const Bone& bone : bones_) {
    obstacles.capsules.push_back({joints.row(bone.from).transpose(), joints.row(bone.to).transpose(), bone.radius_from,
                                  bone.radius_to, bone.yields, bone.belongs});
  }
  return obstacles;
}

}  // namespace bodyloom
