// SPDX-License-Identifier: Apache-2.0
/// Pose correctives of the built-in body: those of its left half for the whole, and those of its fingers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <vector>

#include "data_tools/body_making/left_half_arrays.h"
#include "data_tools/body_making/subdivision.h"
#include "geometry/body/body_model.h"
#include "geometry/body/hand_skeleton.h"

namespace bodyloom {

/// Adds the blocks of left vertices and their mirror images to `all`, of which only joints below `keep_below` stay; a
/// mirrored vertex has its blocks in ascending order of joints. `joint_mirror`: the joint on the other side of each.
void AddCorrectives(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                    const std::map<int, std::vector<CorrectiveBlock>>& left, int keep_below, PoseCorrectives* all);

/// Blocks of the left finger joints, which are first_joint, first_joint + 1, …, by left vertex: fitted to rotations by
/// the weighted angle, which keep a vertex at its distance from the joint. `axes`: of the left hand, `places`: of its
/// joints in the mean shape, `weights`: by index into left_vertices.
std::map<int, std::vector<CorrectiveBlock>> FitFingerCorrectives(const BodyModelData& body, const HandSkeleton& axes,
                                                                 int first_joint,
                                                                 const std::array<Eigen::Vector3d, kHandJoints>& places,
                                                                 const std::vector<WeightedIndices>& weights,
                                                                 const std::vector<int>& left_vertices);

}  // namespace bodyloom
