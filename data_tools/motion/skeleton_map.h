// SPDX-License-Identifier: Apache-2.0
/// Joint map of a foreign skeleton: identifies its hips, knees, elbows, …
///
/// Knees, ankles, toes, elbows, wrists and the head are found by name (the vocabularies of CMU, Mixamo, Acclaim, Biped,
/// DeepMimic, AMP, SMPL); the rest by topology, because their names differ between vocabularies ("LeftShoulder" is a
/// clavicle in one and an upper arm in another): a shoulder is an elbow's parent, a hip a knee's parent, the chest is
/// where the two arms meet, the pelvis where the two legs meet.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "data_tools/motion/skeleton_motion.h"

namespace bodyloom {

/// Indices into the skeleton's joints; −1 for missing ones. Sides: 0 left, 1 right.
struct SkeletonMap {
  int pelvis = -1;
  std::array<int, 2> hip{-1, -1}, knee{-1, -1}, ankle{-1, -1}, toe{-1, -1};
  std::array<int, 2> collar{-1, -1}, shoulder{-1, -1}, elbow{-1, -1}, wrist{-1, -1};
  std::array<int, 2> palm{-1, -1};  ///< carries the hand's orientation: the wrist, or a joint beyond it
  std::vector<int> spine;           ///< from above the pelvis to the chest; may be empty
  std::vector<int> neck;            ///< from above the chest to the head
  /// File axes from body axes (x left, y up, z front) at rest: a permutation of axes with signs.
  Eigen::Matrix3d file_from_body = Eigen::Matrix3d::Identity();
};

/// Throws std::runtime_error beginning with `where` that names the missing joint and those present.
SkeletonMap MapSkeleton(const SkeletonMotion& motion, const std::string& where);

}  // namespace bodyloom
