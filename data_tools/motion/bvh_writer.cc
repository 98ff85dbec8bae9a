// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/bvh_writer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/motion_tools.h"
#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

constexpr double kCentimetresPerMetre = 100;
constexpr double kDegrees = 180 / M_PI;
/// An End Site continues its bone by this share.
constexpr double kEndShare = 0.5;
constexpr double kOneFrameFps = 30;

void AppendNumbers(std::string* text, const Eigen::Vector3d& v) {
  char buffer[96];
  std::snprintf(buffer, sizeof(buffer), "%.9g %.9g %.9g", v.x(), v.y(), v.z());
  *text += buffer;
}

/// (z, x, y) degrees with R = Rz·Rx·Ry; at x = ±90° y is set to zero.
Eigen::Vector3d EulerZxy(const Eigen::Matrix3d& R) {
  const double sin_x = std::clamp(R(2, 1), -1.0, 1.0);
  const double x = std::asin(sin_x);
  if (std::abs(sin_x) > 1 - 1e-12) return Eigen::Vector3d(std::atan2(R(1, 0), R(0, 0)), x, 0) * kDegrees;
  return Eigen::Vector3d(std::atan2(-R(0, 1), R(1, 1)), x, std::atan2(-R(2, 0), R(2, 2))) * kDegrees;
}

class Writer {
 public:
  Writer(const Motion& motion, const BodyModel& model, AnimationRig rig)
      : model_(model),
        skeleton_(RigSkeletonOf(rig, model)),
        rest_(model.RestJoints(motion.betas)),
        children_(model.num_joints()) {
    for (int j = 1; j < static_cast<int>(skeleton_.names.size()); ++j) children_[model.parents()[j]].push_back(j);
    AppendJoint(0, 0);
  }

  [[nodiscard]] const MatrixX3d& rest() const { return rest_; }
  /// Joints in the order of the file.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }
  [[nodiscard]] const std::string& hierarchy() const { return text_; }
  [[nodiscard]] Eigen::Matrix3d FromRest(const BodyPose& pose, int j) const {
    return skeleton_.FromRest(model_, pose, j);
  }

 private:
  void AppendJoint(int j, int level) {
    const std::string indent(2 * level, ' ');
    const int parent = model_.parents()[j];
    const Eigen::RowVector3d offset =
        parent < 0 ? Eigen::RowVector3d::Zero().eval()
                   : ((rest_.row(j) - rest_.row(parent)) * skeleton_.rest_rotations[parent].transpose()).eval();
    text_ +=
        indent + (parent < 0 ? "ROOT " : "JOINT ") + skeleton_.names[j] + "\n" + indent + "{\n" + indent + "  OFFSET ";
    AppendNumbers(&text_, offset.transpose() * kCentimetresPerMetre);
    text_ += "\n" + indent + (parent < 0 ? "  CHANNELS 6 Xposition Yposition Zposition" : "  CHANNELS 3") +
             " Zrotation Xrotation Yrotation\n";
    order_.push_back(j);
    for (const int child : children_[j]) AppendJoint(child, level + 1);
    if (children_[j].empty()) {
      text_ += indent + "  End Site\n" + indent + "  {\n" + indent + "    OFFSET ";
      AppendNumbers(&text_, offset.transpose() * (kEndShare * kCentimetresPerMetre));
      text_ += "\n" + indent + "  }\n";
    }
    text_ += indent + "}\n";
  }

  const BodyModel& model_;
  const RigSkeleton skeleton_;
  MatrixX3d rest_;
  std::vector<std::vector<int>> children_;
  std::vector<int> order_;
  std::string text_ = "HIERARCHY\n";
};

}  // namespace

std::string BvhText(const Motion& motion, const BodyModel& model, AnimationRig rig) {
  CheckMotion(motion, "WriteBvh");
  const double rate = FrameRate(motion);
  BODYLOOM_CHECK(rate > 0 || motion.num_frames() == 1,
                 "WriteBvh: the frames are not evenly spaced in time, which BVH cannot say; resample the motion first");
  const Writer writer(motion, model, rig);
  const Motion y_up = ChangeUp(motion, Motion::Up::kY, writer.rest().row(0).transpose());
  std::string text = writer.hierarchy();
  char line[96];
  std::snprintf(line, sizeof(line), "MOTION\nFrames: %d\nFrame Time: %.9g\n", motion.num_frames(),
                1 / (rate > 0 ? rate : kOneFrameFps));
  text += line;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const BodyPose pose = PoseFromAxisAngle(model, y_up.poses.row(t).transpose(), y_up.trans.row(t).transpose());
    const Eigen::Vector3d pelvis = writer.rest().row(0).transpose() + pose.trans;
    AppendNumbers(&text, pelvis * kCentimetresPerMetre);
    for (const int j : writer.order()) {
      text += ' ';
      AppendNumbers(&text, EulerZxy(writer.FromRest(pose, j)));
    }
    text += '\n';
  }
  return text;
}

void WriteBvh(const std::string& path, const Motion& motion, const BodyModel& model, AnimationRig rig) {
  WriteFileAtomically(path, BvhText(motion, model, rig));
}

}  // namespace bodyloom
