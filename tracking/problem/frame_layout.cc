// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/frame_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

bool IsFinite(const FrameState& state) {
  return state.translation.allFinite() && std::all_of(state.rotations.begin(), state.rotations.end(),
                                                      [](const Eigen::Matrix3d& R) { return R.allFinite(); });
}

using Eigen::Vector3d;
using Eigen::VectorXd;

FrameLayout FrameLayout::Make(const BodyModel& model, CameraKnowledge knowledge, const Camera& camera,
                              std::vector<int> active_joints, int num_betas) {
  FrameLayout layout;
  layout.model = &model;
  layout.knowledge = knowledge;
  layout.camera = camera;
  layout.camera.model = knowledge == CameraKnowledge::kWeak ? CameraModel::kWeakPerspective : CameraModel::kPinhole;
  layout.active_joints = std::move(active_joints);
  layout.column_of_joint.assign(model.num_joints(), -1);
  int column = 0;
  for (int j : layout.active_joints) {
    layout.column_of_joint[j] = column;
    column += 3;
  }
  layout.translation_column = column;
  column += 3;
  layout.beta_column = column;
  layout.num_betas = num_betas;
  layout.num_columns = column;
  if (num_betas > 0) layout.AddSharedBlock(num_betas);
  if (knowledge == CameraKnowledge::kUnknownFocal) {
    layout.focal_column = layout.num_columns;
    layout.AddSharedBlock(1);
  }
  return layout;
}

int FrameLayout::AddSharedBlock(int columns) {
  shared_blocks.push_back({num_columns, columns});
  num_columns += columns;
  return num_blocks() - 1;
}

void FrameLayout::AddView(const ViewUnknowns& view) {
  BODYLOOM_CHECK(knowledge != CameraKnowledge::kWeak && view.knowledge != CameraKnowledge::kWeak,
                 "several views: weak perspective, which has no place in a scene; expected pinhole cameras");
  BODYLOOM_CHECK(column_of_joint[0] >= 0, "several views: the root's rotation is held; expected it to be estimated");
  FrameLayout local = Make(*model, view.knowledge, view.camera, active_joints, num_betas);
  ViewLayout added;
  if (view.pose) {
    added.pose_column = num_columns;
    added.rotation_block = AddSharedBlock(3);
    added.translation_block = AddSharedBlock(3);
  }
  if (local.focal_column >= 0) {
    added.focal_column = num_columns;
    added.focal_block = AddSharedBlock(1);
    added.log_focal_prior = std::log(view.camera.fx);
  }
  if (view.clock) {
    added.clock_column = num_columns;
    added.clock_block = AddSharedBlock(2);
    local.clock_column = local.num_columns;
    local.AddSharedBlock(2);
  }
  added.local = std::make_shared<const FrameLayout>(std::move(local));
  views.push_back(std::move(added));
}

Camera FrameLayout::CameraAt(const FrameState& state, double log_focal) const {
  Camera result = camera;
  if (knowledge == CameraKnowledge::kWeak) {
    result.scale = std::exp(state.translation[0]);
    result.tx = state.translation[1];
    result.ty = state.translation[2];
  } else if (knowledge == CameraKnowledge::kUnknownFocal) {
    result.fx = result.fy = std::exp(log_focal);
  }
  return result;
}

Vector3d FrameLayout::BodyTranslation(const FrameState& state) const {
  return knowledge == CameraKnowledge::kWeak ? Vector3d::Zero() : state.translation;
}

Vector3d FrameLayout::BodyPlace(const FrameState& state) const {
  if (knowledge != CameraKnowledge::kWeak) return state.translation;
  return {state.translation[1], state.translation[2], camera.fx * std::exp(-state.translation[0])};
}

Eigen::Matrix3d FrameLayout::BodyPlaceByTranslation(const FrameState& state) const {
  if (knowledge != CameraKnowledge::kWeak) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d derivative;
  derivative << -BodyPlace(state).z() * Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY();
  return derivative;
}

Eigen::Matrix3d NearbyRotation(const Eigen::Matrix3d& product) {
  return 0.5 * product * (3 * Eigen::Matrix3d::Identity() - product.transpose() * product);
}

VectorXd SharedStep(const FrameLayout& layout, const SharedValues& a, const SharedValues& b) {
  VectorXd step(layout.num_columns - layout.beta_column);
  step.head(layout.num_betas) = b.betas - a.betas;
  const auto at = [&](int column) { return column - layout.beta_column; };
  if (layout.focal_column >= 0) step[at(layout.focal_column)] = b.log_focal - a.log_focal;
  for (size_t v = 0; v < layout.views.size(); ++v) {
    const ViewLayout& view = layout.views[v];
    const ViewState &from = a.views[v], &to = b.views[v];
    if (view.pose_column >= 0) {
      const CameraPose &p = from.camera_from_scene, &q = to.camera_from_scene;
      step.segment<3>(at(view.pose_column)) =
          AxisAngleFromRotation(p.camera_from_world_rotation.transpose() * q.camera_from_world_rotation);
      step.segment<3>(at(view.pose_column) + 3) = q.camera_from_world_translation - p.camera_from_world_translation;
    }
    if (view.focal_column >= 0) step[at(view.focal_column)] = to.log_focal - from.log_focal;
    if (view.clock_column >= 0) {
      step[at(view.clock_column)] = to.offset_s - from.offset_s;
      step[at(view.clock_column) + 1] = to.rate - from.rate;
    }
  }
  return step;
}

SharedValues StepShared(const FrameLayout& layout, const SharedValues& values, const VectorXd& step) {
  SharedValues result = values;
  const auto at = [&](int column) { return column - layout.beta_column; };
  result.betas += step.head(layout.num_betas);
  if (layout.focal_column >= 0) result.log_focal += step[at(layout.focal_column)];
  for (size_t v = 0; v < layout.views.size(); ++v) {
    const ViewLayout& view = layout.views[v];
    ViewState& state = result.views[v];
    if (view.pose_column >= 0) {
      CameraPose& pose = state.camera_from_scene;
      pose.camera_from_world_rotation = NearbyRotation(pose.camera_from_world_rotation *
                                                       RotationFromAxisAngle(step.segment<3>(at(view.pose_column))));
      pose.camera_from_world_translation += step.segment<3>(at(view.pose_column) + 3);
    }
    if (view.focal_column >= 0) state.log_focal += step[at(view.focal_column)];
    if (view.clock_column >= 0) {
      state.offset_s += step[at(view.clock_column)];
      state.rate += step[at(view.clock_column) + 1];
    }
  }
  return result;
}

FrameState InterpolateStates(const FrameState& a, const FrameState& b, double s) {
  FrameState result;
  result.rotations.reserve(a.rotations.size());
  for (size_t j = 0; j < a.rotations.size(); ++j) {
    result.rotations.push_back(InterpolateRotation(a.rotations[j], b.rotations[j], s));
  }
  result.translation = (1 - s) * a.translation + s * b.translation;
  return result;
}

double UprightHeightPx(const FrameLayout& layout, const FrameState& state, double stature_m) {
  if (layout.knowledge == CameraKnowledge::kWeak) return std::exp(state.translation[0]) * stature_m;
  return layout.camera.fy * stature_m / std::max(state.translation.z(), 0.3);
}

}  // namespace bodyloom
