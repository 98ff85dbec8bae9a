// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/put_parts.h"

#include <algorithm>

namespace bodyloom {

std::vector<std::pair<int, std::string>> CocoRowsNamed(const BodyModel& body, const Track& track,
                                                       const std::vector<std::string>& endings) {
  std::vector<std::pair<int, std::string>> rows;
  for (int row = 0; row < static_cast<int>(CocoNames().size()); ++row) {
    const std::string& name = CocoNames()[size_t(row)];
    const bool ends = std::any_of(endings.begin(), endings.end(), [&](const auto& end) { return name.ends_with(end); });
    const bool there = !track.coco17.empty() && row < track.coco17[0].rows() && body.FindLandmark(name) >= 0;
    if (ends && there) rows.emplace_back(row, name);
  }
  return rows;
}

PartOfTrack PartOfHand(const BodyModel& body, const HandSkeleton& hand, const Track& track) {
  const std::string side = hand.side == HandSide::kLeft ? "left" : "right";
  PartOfTrack part;
  part.turned = {body.parents()[size_t(hand.wrist)], hand.wrist};
  part.turned.insert(part.turned.end(), hand.joint.begin(), hand.joint.end());
  part.placed.assign(hand.joint.begin(), hand.joint.end());
  part.landmarks = CocoRowsNamed(body, track, {side + "_wrist", side + "_elbow"});
  return part;
}

PartOfTrack PartOfHead(const BodyModel& body, const Track& track) {
  const int head = body.FindJoint("head");
  PartOfTrack part;
  part.turned = {head};
  for (int j = head + 1; j < body.num_joints(); ++j) {
    const std::vector<int>& above = body.ancestors(j);
    if (std::find(above.begin(), above.end(), head) != above.end()) part.placed.push_back(j);
  }
  part.landmarks = CocoRowsNamed(body, track, {"nose", "_eye", "_ear"});
  return part;
}

void PutPart(const BodyModel& body, const MatrixX3d& rest, const BodyPose& pose, const PartOfTrack& part, int t,
             Track* track) {
  const Eigen::VectorXd axis_angles = AxisAngleFromPose(body, pose);
  const PosedSkeleton skeleton = PoseSkeleton(body, rest, pose);
  for (const int joint : part.turned) {
    track->motion.poses.row(t).segment<3>(Eigen::Index{3} * joint) = axis_angles.segment<3>(Eigen::Index{3} * joint);
  }
  for (const int joint : part.placed) track->joints[size_t(t)].row(joint) = skeleton.joints.row(joint);
  std::vector<std::string> names;
  for (const auto& [row, name] : part.landmarks) names.push_back(name);
  if (names.empty()) return;
  const MatrixX3d places = PoseLandmarks(body, track->motion.betas, pose, names);
  for (size_t i = 0; i < names.size(); ++i) {
    track->coco17[size_t(t)].row(part.landmarks[i].first) = places.row(Eigen::Index(i));
  }
}

}  // namespace bodyloom
