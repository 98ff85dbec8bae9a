// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/moving_camera.h"

#include "geometry/scene/camera_path.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

FrameState StateInCamera(const FrameLayout& layout, const CameraPose& camera_from_scene, const VectorXd& betas,
                         FrameState state) {
  const BodyModel& model = *layout.model;
  Vector3d pelvis = model.joint_template().row(0).transpose();
  if (betas.size() > 0) pelvis += model.joint_shapedirs().block(0, 0, 3, betas.size()) * betas;
  state.rotations[0] = camera_from_scene.camera_from_world_rotation * state.rotations[0];
  state.translation = MovedPoint(camera_from_scene, pelvis + state.translation) - pelvis;
  return state;
}

FrameState StateInCamera(const SequenceProblem& problem, size_t t) {
  const CameraPose* camera_from_scene = problem.frames[t].camera_from_scene;
  if (camera_from_scene == nullptr) return problem.states[t];
  return StateInCamera(problem.layout, *camera_from_scene, problem.betas, problem.states[t]);
}

void TakeToScene(const FrameLayout& layout, const CameraPose& camera_from_scene, FrameSystem* system) {
  const int p = layout.num_columns, t = layout.translation_column, b = layout.beta_column, B = layout.num_betas;
  const Matrix3d& R = camera_from_scene.camera_from_world_rotation;
  const MatrixXd K = (R - Matrix3d::Identity()) * layout.model->joint_shapedirs().block(0, 0, 3, B);
  VectorXd& g = system->gradient;
  g.segment(b, B) += K.transpose() * g.segment<3>(t);
  g.segment<3>(t) = (R.transpose() * g.segment<3>(t)).eval();

  const MatrixXd H = system->H.selfadjointView<Eigen::Lower>();
  MatrixXd HT = H;  // H T, of which columns of translation and shape differ from H
  HT.middleCols<3>(t).noalias() = H.middleCols<3>(t) * R;
  HT.middleCols(b, B).noalias() += H.middleCols<3>(t) * K;
  MatrixXd rows = HT.middleRows<3>(t);
  HT.middleRows(b, B).noalias() += K.transpose() * rows;
  HT.middleRows<3>(t).noalias() = R.transpose() * rows;
  system->H.topLeftCorner(p, p) = HT;
}

void TakeRowsToScene(const FrameLayout& layout, const CameraPose& camera_from_scene, Eigen::Ref<RowMatrixXd> J) {
  const int t = layout.translation_column, b = layout.beta_column, B = layout.num_betas;
  const Matrix3d& R = camera_from_scene.camera_from_world_rotation;
  const MatrixXd K = (R - Matrix3d::Identity()) * layout.model->joint_shapedirs().block(0, 0, 3, B);
  J.middleCols(b, B) += J.middleCols<3>(t) * K;
  J.middleCols<3>(t) = (J.middleCols<3>(t) * R).eval();
}

}  // namespace bodyloom
