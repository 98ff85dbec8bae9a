// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/observability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/body/hand_skeleton.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/user_cost.h"

namespace bodyloom {
namespace {

constexpr double kMinLever = 0.04;  ///< metres a radian

}  // namespace

std::vector<int> FindActiveJoints(const BodyModel& model, const ObservedLandmarks& landmarks, bool dense, bool skip,
                                  bool ground, std::span<const UserTerm> user_terms) {
  std::vector<int> all(model.num_joints());
  std::iota(all.begin(), all.end(), 0);
  if (!skip) return all;
  std::vector<bool> finger(model.num_joints(), false);
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    for (const std::string& name : HandJointNames(side)) {
      if (const int j = model.FindJoint(name); j >= 0) finger[j] = true;
    }
  }
  Kinematics kinematics;
  PointEvaluator points;
  kinematics.Set(model, Eigen::VectorXd(),
                 std::vector<Eigen::Matrix3d>(model.num_joints(), Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero(),
                 true);
  std::vector<double> lever(model.num_joints(), 0);
  const auto add = [&](const CompiledPoint& point) {
    points.Evaluate(kinematics, point, true);
    for (int j : points.joints())
      lever[j] = std::max(lever[j], points.JointJacobian(kinematics, j).norm() / std::sqrt(2.0));
  };
  for (const CompiledPoint& point : landmarks.points) add(point);
  for (const UserTerm& term : user_terms) {
    const auto compiled = CompileInputs(term, model, 1);
    for (const CompiledInputs::Input& input : compiled->inputs) {
      if (!input.vertices.empty()) add(CompilePoint(model, input.vertices, input.weights, 0));
      if (input.kind == TermInput::Kind::kRotation) lever.at(input.joint) = std::max(lever[input.joint], kMinLever);
    }
  }
  if (ground) {
    for (const char* ankle : {"l_ankle", "r_ankle"}) {
      if (const int j = model.FindJoint(ankle); j >= 0) lever[j] = std::max(lever[j], kMinLever);
    }
  }
  std::vector<int> active;
  for (int j : all) {
    if (j == 0 || (dense && !finger[j]) || lever[j] >= kMinLever) active.push_back(j);
  }
  return active;
}

}  // namespace bodyloom
