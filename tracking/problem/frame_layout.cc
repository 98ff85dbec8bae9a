// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/frame_layout.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/math/rotation.h"

namespace bodyloom {

bool IsFinite(const FrameState& state) {
  return state.translation.allFinite() && std::all_of(state.rotations.begin(), state.rotations.end(),
                                                      [](const Eigen::Matrix3d& R) { return R.allFinite(); });
}

using Eigen::Vector3d;

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
  column += num_betas;
  if (knowledge == CameraKnowledge::kUnknownFocal) layout.focal_column = column++;
  layout.num_columns = column;
  return layout;
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
