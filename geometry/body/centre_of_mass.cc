// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/centre_of_mass.h"

#include <array>
#include <limits>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr std::array<SegmentMass, 14> kSegmentMasses = {{
    {"head", {"neck", "neck"}, {"head", "head"}, 0.0681, 1.2},
    {"trunk", {"l_shoulder", "r_shoulder"}, {"l_hip", "r_hip"}, 0.4302, 0.405},
    {"left upper arm", {"l_shoulder", "l_shoulder"}, {"l_elbow", "l_elbow"}, 0.0263, 0.576},
    {"right upper arm", {"r_shoulder", "r_shoulder"}, {"r_elbow", "r_elbow"}, 0.0263, 0.576},
    {"left forearm", {"l_elbow", "l_elbow"}, {"l_wrist", "l_wrist"}, 0.0150, 0.457},
    {"right forearm", {"r_elbow", "r_elbow"}, {"r_wrist", "r_wrist"}, 0.0150, 0.457},
    {"left hand", {"l_elbow", "l_elbow"}, {"l_wrist", "l_wrist"}, 0.00585, 1.24},
    {"right hand", {"r_elbow", "r_elbow"}, {"r_wrist", "r_wrist"}, 0.00585, 1.24},
    {"left thigh", {"l_hip", "l_hip"}, {"l_knee", "l_knee"}, 0.1447, 0.385},
    {"right thigh", {"r_hip", "r_hip"}, {"r_knee", "r_knee"}, 0.1447, 0.385},
    {"left shank", {"l_knee", "l_knee"}, {"l_ankle", "l_ankle"}, 0.0457, 0.437},
    {"right shank", {"r_knee", "r_knee"}, {"r_ankle", "r_ankle"}, 0.0457, 0.437},
    {"left foot", {"l_ankle", "l_ankle"}, {"l_foot", "l_foot"}, 0.0133, 0.4},
    {"right foot", {"r_ankle", "r_ankle"}, {"r_foot", "r_foot"}, 0.0133, 0.4},
}};

}  // namespace

std::span<const SegmentMass> SegmentMasses() { return kSegmentMasses; }

Eigen::VectorXd MassByJoint(const BodyModel& body) {
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(body.num_joints());
  for (const SegmentMass& segment : kSegmentMasses) {
    for (const int k : {0, 1}) {
      const int from = body.FindJoint(segment.from[k]), to = body.FindJoint(segment.to[k]);
      if (from < 0 || to < 0) return {};
      mass[from] += 0.5 * segment.share * (1 - segment.along);
      mass[to] += 0.5 * segment.share * segment.along;
    }
  }
  return mass;
}

Eigen::Vector3d CentreOfMass(const MatrixX3d& joints, const Eigen::VectorXd& mass_by_joint) {
  BODYLOOM_CHECK(joints.rows() == mass_by_joint.size(), "centre of mass: ", joints.rows(), " joints, expected ",
                 mass_by_joint.size());
  return joints.transpose() * mass_by_joint;
}

Eigen::Vector2d ZeroMomentPoint(const Eigen::Vector3d& c, const Eigen::Vector3d& acceleration) {
  const double lift = kGravity + acceleration.y();
  if (!(lift > 0)) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return Eigen::Vector2d(c.x(), c.z()) - c.y() / lift * Eigen::Vector2d(acceleration.x(), acceleration.z());
}

}  // namespace bodyloom
