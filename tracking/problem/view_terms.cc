// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/view_terms.h"

#include <algorithm>

#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

CameraPose CameraOfView(const ViewTerms& view, const ViewState& pose) {
  return view.camera_from_own ? Compose(*view.camera_from_own, pose.camera_from_scene) : pose.camera_from_scene;
}

ViewColumns::ViewColumns(const FrameLayout& layout, const ViewTerms& view, const ViewState& pose,
                         const FrameState& state, const VectorXd& betas)
    : layout_(layout),
      view_(layout.views[view.view]),
      rotation_(CameraOfView(view, pose).camera_from_world_rotation),
      clock_s_(view.clock_s) {
  if (view.camera_from_own) own_rotation_ = view.camera_from_own->camera_from_world_rotation;
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
    if (own_rotation_) {
      J.middleCols<3>(view_.pose_column + 3).noalias() = move * *own_rotation_;
    } else {
      J.middleCols<3>(view_.pose_column + 3) = move;
    }
  }
  if (view_.focal_column >= 0) J.col(view_.focal_column) = in_view.col(local.focal_column);
  if (view_.clock_column >= 0) {
    J.col(view_.clock_column) = in_view.col(local.clock_column);
    J.col(view_.clock_column + 1) = clock_s_ * in_view.col(local.clock_column);
  }
}

void ViewColumns::AddSums(const FrameSystem& in_view, FrameSystem* system) const {
  // M is the identity for the joints, which come first in both. So only H's rows of the root and of the columns after
  // the joints are needed, and the columns of the layout that the view depends on besides the joints.
  const FrameLayout& local = *view_.local;
  const int root = layout_.column_of_joint[0], t = layout_.translation_column, B = layout_.num_betas;
  thread_local std::vector<int> columns;  // ascending
  columns.clear();
  const auto add = [&](int first, int number) {
    for (int i = 0; first >= 0 && i < number; ++i) columns.push_back(first + i);
  };
  add(t, 3);
  add(layout_.beta_column, B);
  add(view_.pose_column, 6);
  add(view_.focal_column, 1);
  add(view_.clock_column, 2);
  // Mᵀ of rows in the order root, translation, shape, focal length, clock: rows in the order of `columns`.
  const auto take = [&](const RowMatrixXd& rows, RowMatrixXd* taken) {
    const auto turn = rows.topRows<3>(), move = rows.middleRows<3>(3);
    taken->topRows<3>().noalias() = rotation_.transpose() * move;
    taken->middleRows(3, B) = rows.middleRows(6, B);
    taken->middleRows(3, B).noalias() += by_betas_.transpose() * move;
    Eigen::Index from = 6 + B, to = 3 + B;
    if (view_.pose_column >= 0) {
      taken->middleRows<3>(to).noalias() = by_turn_.topRows<3>().transpose() * turn;
      taken->middleRows<3>(to).noalias() += by_turn_.bottomRows<3>().transpose() * move;
      if (own_rotation_) {
        taken->middleRows<3>(to + 3).noalias() = own_rotation_->transpose() * move;
      } else {
        taken->middleRows<3>(to + 3) = move;
      }
      to += 6;
    }
    if (local.focal_column >= 0) taken->row(to++) = rows.row(from++);
    if (view_.clock_column >= 0) {
      taken->row(to) = rows.row(from);
      taken->row(to + 1) = clock_s_ * rows.row(from);
    }
  };
  const Eigen::Index n = in_view.gradient.size(), rest = n - t, count = static_cast<Eigen::Index>(columns.size());
  thread_local RowMatrixXd rows, taken, back, both;
  rows.resize(3 + rest, n + 1);  // the last column is the gradient
  const auto copy = [&](Eigen::Index to, Eigen::Index from) {
    rows.row(to).head(from) = in_view.H.row(from).head(from);
    rows.row(to).segment(from, n - from) = in_view.H.col(from).tail(n - from).transpose();
    rows(to, n) = in_view.gradient[from];
  };
  for (int i = 0; i < 3; ++i) copy(i, root + i);
  for (Eigen::Index i = 0; i < rest; ++i) copy(3 + i, t + i);
  taken.resize(count, n + 1);
  take(rows, &taken);
  back.resize(3 + rest, count);
  back.topRows<3>() = taken.middleCols<3>(root).transpose();
  back.bottomRows(rest) = taken.middleCols(t, rest).transpose();
  both.resize(count, count);
  take(back, &both);
  for (int j = 0; j < t; ++j) {
    system->H.col(j).segment(j, t - j) += in_view.H.col(j).segment(j, t - j);
    for (Eigen::Index i = 0; i < count; ++i) system->H(columns[i], j) += taken(i, j);
  }
  system->gradient.head(t) += in_view.gradient.head(t);
  for (Eigen::Index i = 0; i < count; ++i) {
    system->gradient[columns[i]] += taken(i, n);
    for (Eigen::Index j = 0; j <= i; ++j) system->H(columns[i], columns[j]) += both(i, j);
  }
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
