// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/skeleton_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "data_tools/formats/printable.h"

namespace bodyloom {
namespace {

using Tokens = std::vector<std::string>;

/// "mixamorig:LeftForeArm" → "leftforearm".
std::string PlainName(const std::string& name) {
  std::string plain;
  const size_t colon = name.rfind(':');
  for (const char c : name.substr(colon == std::string::npos ? 0 : colon + 1)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) plain += static_cast<char>(std::tolower(c));
  }
  for (const char* prefix : {"mixamorig", "bip01", "bip001"}) {
    if (plain.starts_with(prefix)) return plain.substr(std::string(prefix).size());
  }
  return plain;
}

class Finder {
 public:
  Finder(const SkeletonMotion& motion, std::string where) : motion_(motion), where_(std::move(where)) {
    for (const std::string& name : motion.names) names_.push_back(PlainName(name));
  }

  /// The first joint called by one of the tokens (in their order) on that side; −1 when there is none.
  [[nodiscard]] int Find(int side, const Tokens& tokens) const {
    const std::string full = side == 0 ? "left" : "right", letter = side == 0 ? "l" : "r";
    for (const std::string& token : tokens) {
      for (const std::string& name : {full + token, letter + token, token + full, token + letter}) {
        const auto found = std::find(names_.begin(), names_.end(), name);
        if (found != names_.end()) return static_cast<int>(found - names_.begin());
      }
    }
    return -1;
  }
  [[nodiscard]] int Require(int side, const Tokens& tokens) const {
    const int joint = Find(side, tokens);
    if (joint < 0) Fail(std::string("no ") + (side == 0 ? "left " : "right ") + tokens[0]);
    return joint;
  }
  [[nodiscard]] int FindMiddle(const Tokens& tokens) const {
    for (const std::string& token : tokens) {
      const auto found = std::find(names_.begin(), names_.end(), token);
      if (found != names_.end()) return static_cast<int>(found - names_.begin());
    }
    return -1;
  }
  [[nodiscard]] int Parent(int joint, const std::string& what) const {
    if (motion_.parents[joint] < 0)
      Fail("'" + PrintableText(motion_.names[joint]) + "' is the root, expected " + what + " above it");
    return motion_.parents[joint];
  }
  /// Joints from `joint` up to the root, both included.
  [[nodiscard]] std::vector<int> Upwards(int joint) const {
    std::vector<int> path;
    for (int j = joint; j >= 0; j = motion_.parents[j]) path.push_back(j);
    return path;
  }
  [[nodiscard]] int CommonAncestor(int a, int b) const {
    const std::vector<int> path = Upwards(a);
    for (const int j : Upwards(b)) {
      if (std::find(path.begin(), path.end(), j) != path.end()) return j;
    }
    return 0;
  }
  /// From below `top` down to `bottom`; `top` must be an ancestor of `bottom` or itself.
  [[nodiscard]] std::vector<int> Chain(int top, int bottom) const {
    std::vector<int> chain;
    for (int j = bottom; j >= 0 && j != top; j = motion_.parents[j]) chain.push_back(j);
    std::reverse(chain.begin(), chain.end());
    return chain;
  }
  [[nodiscard]] bool IsBelow(int joint, int ancestor) const {
    const std::vector<int> path = Upwards(joint);
    return joint != ancestor && std::find(path.begin(), path.end(), ancestor) != path.end();
  }
  [[noreturn]] void Fail(const std::string& message) const {
    throw std::runtime_error(where_ + ": the skeleton is not recognised as a person's: " + message +
                             "; its joints are " + PrintableList(motion_.names));
  }

 private:
  const SkeletonMotion& motion_;
  std::string where_;
  std::vector<std::string> names_;
};

/// The signed axis nearest to v.
Eigen::Vector3d NearestAxis(const Eigen::Vector3d& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return Eigen::Vector3d::Unit(axis) * (v[axis] < 0 ? -1 : 1);
}

Eigen::Matrix3d BodyAxes(const SkeletonMotion& motion, const SkeletonMap& map, const Finder& finder) {
  const MatrixX3d rest = RestPositions(motion);
  const auto at = [&](int j) -> Eigen::Vector3d { return rest.row(j); };
  const Eigen::Vector3d mid_hip = 0.5 * (at(map.hip[0]) + at(map.hip[1]));
  const Eigen::Vector3d shoulders = 0.5 * (at(map.shoulder[0]) + at(map.shoulder[1]));
  const Eigen::Vector3d knees = 0.5 * (at(map.knee[0]) + at(map.knee[1]));
  const Eigen::Vector3d up = NearestAxis(shoulders - knees);
  Eigen::Vector3d left = at(map.hip[0]) - at(map.hip[1]);
  if (!(left.norm() > 0)) left = at(map.shoulder[0]) - at(map.shoulder[1]);
  left -= left.dot(up) * up;
  if (!(left.norm() > 0) || !((shoulders - knees).norm() > 0) || !((mid_hip - knees).norm() > 0)) {
    finder.Fail("the rest pose has no left, up or leg length");
  }
  Eigen::Matrix3d axes;
  axes.col(0) = NearestAxis(left);
  axes.col(1) = up;
  axes.col(2) = axes.col(0).cross(up);
  return axes;
}

}  // namespace

SkeletonMap MapSkeleton(const SkeletonMotion& motion, const std::string& where) {
  const Finder finder(motion, where);
  SkeletonMap map;
  for (int side = 0; side < 2; ++side) {
    map.knee[side] = finder.Require(side, {"knee", "leg", "lowerleg", "lowleg", "tibia", "shin", "calf"});
    map.ankle[side] = finder.Require(side, {"ankle", "foot"});
    map.toe[side] = finder.Find(side, {"toebase", "toe", "toes", "ball", "foot"});
    if (map.toe[side] == map.ankle[side]) map.toe[side] = -1;
    map.elbow[side] = finder.Require(side, {"elbow", "forearm", "lowerarm", "lowarm", "radius"});
    map.wrist[side] = finder.Require(side, {"wrist", "hand"});
    map.palm[side] = finder.Find(side, {"fingerbase", "hand", "palm"});
    if (map.palm[side] < 0 || !finder.IsBelow(map.palm[side], map.wrist[side])) map.palm[side] = map.wrist[side];
    map.hip[side] = finder.Parent(map.knee[side], "a hip");
    map.shoulder[side] = finder.Parent(map.elbow[side], "a shoulder");
    const bool is_leg = finder.IsBelow(map.ankle[side], map.knee[side]);
    if (!is_leg || !finder.IsBelow(map.wrist[side], map.elbow[side])) finder.Fail("the limbs are not chains");
  }
  map.pelvis = finder.CommonAncestor(map.hip[0], map.hip[1]);
  const int chest = finder.CommonAncestor(map.shoulder[0], map.shoulder[1]);
  map.spine = finder.Chain(finder.CommonAncestor(map.pelvis, chest), chest);
  for (int side = 0; side < 2; ++side) {
    const std::vector<int> arm = finder.Chain(chest, map.shoulder[side]);
    if (arm.size() >= 2) map.collar[side] = arm[arm.size() - 2];
  }
  const int head = finder.FindMiddle({"head", "neck1", "neck"});
  if (head < 0 || !finder.IsBelow(head, chest)) finder.Fail("no head above the chest");
  map.neck = finder.Chain(chest, head);
  map.file_from_body = BodyAxes(motion, map, finder);
  return map;
}

}  // namespace bodyloom
