// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/view_terms.h"

#include <algorithm>

#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

ViewColumns::ViewColumns(const FrameLayout& layout, const ViewLayout& view, const ViewState& pose,
                         const FrameState& state, const VectorXd& betas, double clock_s)
    : layout_(layout), view_(view), rotation_(pose.camera_from_scene.camera_from_world_rotation), clock_s_(clock_s) {
  const BodyModel& model = *layout.model;
  const int B = layout.num_betas;
  Vector3d pelvis = model.joint_template().row(0).transpose();
  if (B > 0) pelvis += model.joint_shapedirs().block(0, 0, 3, B) * betas;
  by_turn_.topRows<3>() = state.rotations[0].transpose();
  by_turn_.bottomRows<3>() = -rotation_ * Skew(pelvis + state.translation);
  by_betas_ = (rotation_ - Matrix3d::Identity()) * model.joint_shapedirs().block(0, 0, 3, B);
}

void ViewColumns::TakeRows(const Eigen::Ref<const RowMatrixXd>& in_view, Eigen::Ref<RowMatrixXd> J) const {
  const FrameLayout& local = *view_.local;
  const int root = layout_.column_of_joint[0], t = layout_.translation_column, B = layout_.num_betas;
  const auto turn = in_view.middleCols<3>(root), move = in_view.middleCols<3>(t);
  J.setZero();
  J.leftCols(t) = in_view.leftCols(t);
  J.middleCols<3>(t).noalias() = move * rotation_;
  J.middleCols(layout_.beta_column, B) = in_view.middleCols(local.beta_column, B);
  J.middleCols(layout_.beta_column, B).noalias() += move * by_betas_;
  if (view_.pose_column >= 0) {
    J.middleCols<3>(view_.pose_column).noalias() = turn * by_turn_.topRows<3>();
    J.middleCols<3>(view_.pose_column).noalias() += move * by_turn_.bottomRows<3>();
    J.middleCols<3>(view_.pose_column + 3) = move;
  }
  if (view_.focal_column >= 0) J.col(view_.focal_column) = in_view.col(local.focal_column);
  if (view_.clock_column >= 0) {
    J.col(view_.clock_column) = in_view.col(local.clock_column);
    J.col(view_.clock_column + 1) = clock_s_ * in_view.col(local.clock_column);
  }
}

void ViewColumns::AddSums(const FrameSystem& in_view, FrameSystem* system) const {
  // H M by columns, and then Mᵀ (H M) = ((H M)ᵀ M)ᵀ the same way.
  thread_local RowMatrixXd H, HM, both;
  const Eigen::Index local = in_view.gradient.size(), all = layout_.num_columns;
  H = in_view.H.selfadjointView<Eigen::Lower>();
  HM.resize(local, all);
  TakeRows(H, HM);
  H = HM.transpose();
  both.resize(all, all);
  TakeRows(H, both);
  system->H.triangularView<Eigen::Lower>() += both;
  RowMatrixXd gradient(1, all);
  TakeRows(in_view.gradient.transpose(), gradient);
  system->gradient += gradient.transpose();
}

std::vector<int> ViewColumns::Blocks(const std::vector<int>& in_view) const {
  const FrameLayout& local = *view_.local;
  const int root = FrameLayout::BlockOfColumn(layout_.column_of_joint[0]);
  std::vector<int> blocks;
  const auto add = [&](int block) {
    if (block >= 0) blocks.push_back(block);
  };
  for (const int block : in_view) {
    if (block < local.TranslationBlock()) {
      add(block);
      if (block == root) add(view_.rotation_block);
    } else if (block == local.TranslationBlock()) {
      add(block);
      add(layout_.BetaBlock());
      add(view_.rotation_block);
      add(view_.translation_block);
    } else if (block == local.BetaBlock()) {
      add(layout_.BetaBlock());
    } else if (block == local.FocalBlock()) {
      add(view_.focal_block);
    } else {
      add(view_.clock_block);
    }
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

}  // namespace bodyloom
