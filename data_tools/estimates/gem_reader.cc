// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/estimate_readers.h"

#include <array>
#include <vector>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

constexpr int kSomaJoints = 77, kSmplBodyJoints = 22;

/// Parents of SOMA's joints.
constexpr std::array<int, kSomaJoints> kSomaParents = {
    -1, 0,  1,  2,  3,  4,  5,  6,  6,  6,  6,  3,  11, 12, 13, 14, 15, 16, 17, 14, 19, 20, 21, 22, 14, 24,
    25, 26, 27, 14, 29, 30, 31, 32, 14, 34, 35, 36, 37, 3,  39, 40, 41, 42, 43, 44, 45, 42, 47, 48, 49, 50,
    42, 52, 53, 54, 55, 42, 57, 58, 59, 60, 42, 62, 63, 64, 65, 0,  67, 68, 69, 70, 0,  72, 73, 74, 75};
/// SOMA's joints in the places of SMPL's first 22: Hips, LeftLeg, RightLeg, Spine1, LeftShin, RightShin, Spine2,
/// LeftFoot, RightFoot, Chest, LeftToeBase, RightToeBase, Neck1, LeftShoulder, RightShoulder, Head, LeftArm, RightArm,
/// LeftForeArm, RightForeArm, LeftHand, RightHand; and SMPL's parents.
constexpr std::array<int, kSmplBodyJoints> kSomaOfSmpl = {0,  67, 72, 1,  68, 73, 2,  69, 74, 3,  70,
                                                          75, 4,  11, 39, 6,  12, 40, 13, 41, 14, 42};
constexpr std::array<int, kSmplBodyJoints> kParentsOfSmpl = {-1, 0, 0, 0, 1,  2,  3,  4,  5,  6,  7,
                                                             8,  9, 9, 9, 12, 13, 14, 16, 17, 18, 19};

/// The dictionary of the motion, with a dot behind it; empty if there is none. net_outputs holds more of them.
std::string PrefixOf(const WeightsFile& file) {
  for (const auto& [name, tensor] : file.tensors) {
    const std::string prefix = name.substr(0, name.find('.') + 1);
    if (prefix.ends_with("_params_incam.") && prefix != "smpl_params_incam." && name == prefix + "body_pose") {
      return prefix;
    }
  }
  return "";
}

/// `pose`: 76 rotations of SOMA; sets columns 3 to 66 of a row of SMPL's.
void SetSmplPose(const Eigen::Vector3d& root, const Eigen::Ref<const Eigen::RowVectorXd>& pose,
                 Eigen::Ref<Eigen::RowVectorXd> row) {
  std::array<Eigen::Matrix3d, kSomaJoints> turned;
  turned[0] = RotationFromAxisAngle(root);
  for (int j = 1; j < kSomaJoints; ++j) {
    turned[size_t(j)] = turned[size_t(kSomaParents[size_t(j)])] *
                        RotationFromAxisAngle(pose.segment<3>(3 * Eigen::Index(j - 1)).transpose());
  }
  for (int j = 1; j < kSmplBodyJoints; ++j) {
    const Eigen::Matrix3d& parent = turned[size_t(kSomaOfSmpl[size_t(kParentsOfSmpl[size_t(j)])])];
    row.segment<3>(3 * Eigen::Index(j)) =
        AxisAngleFromRotation(parent.transpose() * turned[size_t(kSomaOfSmpl[size_t(j)])]).transpose();
  }
}

}  // namespace

bool IsGem(const WeightsFile& file) { return !PrefixOf(file).empty(); }

BodyEstimate GemFromTensors(const WeightsFile& file, const std::string& where) {
  constexpr int64_t kSmplColumns = 63, kSomaColumns = 3 * (kSomaJoints - 1);
  const std::string prefix = PrefixOf(file);
  const NdArray& pose = RequireTensor(file, prefix + "body_pose", where);
  const int64_t L = pose.shape.empty() ? 0 : pose.shape[0];
  const int64_t columns = L > 0 ? pose.num_elements() / L : 0;
  if (L < 1 || L >= kMaxEstimateFrames || (columns != kSmplColumns && columns != kSomaColumns)) {
    ThrowFileError(where, prefix + "body_pose", pose.ShapeText() + ", expected Lx63 (SMPL-X) or Lx228 (SOMA)");
  }
  const bool is_soma = columns == kSomaColumns;
  BodyEstimate estimate;
  estimate.system = is_soma ? "GEM-X" : "GEM";
  estimate.body = is_soma ? "soma" : "smplx";
  if (!is_soma) estimate.rest_pelvis = MeanPelvis(estimate.body);
  PersonEstimate& person = estimate.people.emplace_back();
  SetInCameraMotion(file, prefix, L, where, &person);
  const RowMatrixXd body = RequireShape(pose, pose.shape, where, prefix + "body_pose");
  for (Eigen::Index t = 0; t < body.rows(); ++t) {
    if (is_soma) {
      SetSmplPose(person.poses.row(t).head<3>().transpose(), body.row(t), person.poses.row(t));
      if (!person.poses.row(t).allFinite()) {
        ThrowFileError(where, prefix + "body_pose", Concatenate("frame ", t, " has angles beyond any turn"));
      }
    } else {
      person.poses.row(t).segment<63>(3) = body.row(t);
    }
  }
  if (!is_soma) person.betas = MeanBetas(RequireTensor(file, prefix + "betas", where), L, where);
  estimate.num_frames = int(L);
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
