// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/smpl_rest.h"

#include <array>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

const MatrixX3d& SmplRestJoints() {
  static const MatrixX3d joints = [] {
    MatrixX3d J(24, 3);
    J << 0, 0, 0,                                       // pelvis
        0.081, -0.081, 0.016, -0.081, -0.081, 0.016,    // hips
        0, 0.116, -0.001,                               // spine1
        0.126, -0.472, 0.008, -0.126, -0.472, 0.008,    // knees
        0, 0.247, -0.007,                               // spine2
        0.140, -0.900, -0.005, -0.140, -0.900, -0.005,  // ankles
        0, 0.305, -0.011,                               // spine3
        0.155, -0.963, 0.115, -0.155, -0.963, 0.115,    // feet
        0, 0.487, 0.023,                                // neck
        0.088, 0.401, 0.037, -0.088, 0.401, 0.037,      // collars
        0, 0.585, 0.059,                                // head
        0.177, 0.416, 0.035, -0.177, 0.416, 0.035,      // shoulders
        0.422, 0.417, 0.035, -0.422, 0.417, 0.035,      // elbows
        0.663, 0.416, 0.035, -0.663, 0.416, 0.035,      // wrists
        0.763, 0.419, 0.033, -0.763, 0.419, 0.033;      // hands
    return J;
  }();
  return joints;
}

MatrixX3d PoseSmplJoints(const Eigen::Ref<const Eigen::VectorXd>& pose, const Eigen::Vector3d& pelvis) {
  BODYLOOM_CHECK(pose.size() == 72, "pose has ", pose.size(), " values, expected 72");
  const MatrixX3d& rest = SmplRestJoints();
  std::array<Eigen::Matrix3d, 24> world;
  MatrixX3d joints(24, 3);
  for (int j = 0; j < 24; ++j) {
    const Eigen::Matrix3d local = RotationFromAxisAngle(pose.segment<3>(3 * j));
    const int p = SmplParents()[j];
    if (p < 0) {
      world[j] = local;
      joints.row(j) = pelvis.transpose();
      continue;
    }
    world[j] = world[p] * local;
    joints.row(j) = joints.row(p) + (rest.row(j) - rest.row(p)) * world[p].transpose();
  }
  return joints;
}

std::vector<MatrixX3d> PoseSmplJoints(const Motion& motion) {
  std::vector<MatrixX3d> joints;
  joints.reserve(motion.num_frames());
  for (int t = 0; t < motion.num_frames(); ++t) {
    joints.push_back(PoseSmplJoints(motion.poses.row(t).transpose(), motion.trans.row(t).transpose()));
  }
  return joints;
}

Eigen::Vector4d HingeFlexionDeg(const Eigen::Ref<const Eigen::VectorXd>& pose) {
  BODYLOOM_CHECK(pose.size() >= 66, "pose has ", pose.size(), " values, expected 72");
  const auto flexion = [&](int joint, const Eigen::Vector3d& bone, const Eigen::Vector3d& bends_towards) {
    const Eigen::Vector3d bent = RotationFromAxisAngle(pose.segment<3>(3 * joint)) * bone;
    return std::atan2(bent.dot(bends_towards), bent.dot(bone)) * 180 / M_PI;
  };
  const Eigen::Vector3d down(0, -1, 0), left(1, 0, 0), right(-1, 0, 0), front(0, 0, 1), back(0, 0, -1);
  return {flexion(4, down, back), flexion(5, down, back), flexion(18, left, front), flexion(19, right, front)};
}

}  // namespace bodyloom
