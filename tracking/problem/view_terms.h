// SPDX-License-Identifier: Apache-2.0
/// Terms of further views: other cameras that show the same body, each with a pose, a focal length and a clock that may
/// be unknown.
///
/// A view's terms are those of term_kinds.h by themselves: they are evaluated in the view's camera frame with its
/// intrinsics (ViewLayout::local), and their sums are transformed to the unknowns of the problem, as those of a moving
/// camera are (moving_camera.h). With R, t the pose camera_from_scene, R0 the root's rotation, J0(β) the pelvis at rest
/// and p = J0 + trans the pelvis in the scene, the body in the view is
///   R_root' = R R0,   trans' = R p + t − J0.
/// For right increments ω of R and δ of R0, to first order
///   δ' = δ + R0ᵀ ω,   d trans' = R d trans + (R − I) (∂J0/∂β) dβ − R [p]× ω + dt.
/// So derivatives by the root's rotation and by the translation in the view give those by the camera's pose.
///
/// A view that moves has a path: the poses P, p of its camera at each moment in a scene of its own, in metres.
/// camera_from_scene (Q, q) then leads from the scene to that one, and above R = P Q and t = P q + p: ω is the
/// increment of Q, and the last term of d trans' is P dq.
///
/// Clock: the terms were observed where the view's clock shows a certain time. When it is moved by s seconds, an
/// observed pixel y with velocity ẏ is at y + s ẏ (LandmarkObservation): s = offset_s + rate τ − sampled_s, with τ the
/// frame's time since the clip's middle. The dependence is linear until the observations are made again.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

/// Terms of a frame in another view.
struct ViewTerms {
  int view = 0;                               ///< index into FrameLayout::views and SharedValues::views
  double clock_s = 0;                         ///< τ
  double sampled_s = 0;                       ///< offset_s + rate τ of the times at which the terms were observed
  std::optional<CameraPose> camera_from_own;  ///< at that time, of a view that moves, from its own scene
  TermList terms;
};

/// Pose of the view's camera in the scene at the moment of its terms.
CameraPose CameraOfView(const ViewTerms& view, const ViewState& pose);

/// Derivatives of a view's root rotation and translation by the unknowns of the problem, and the columns of all.
class ViewColumns {
 public:
  /// `state` is in the scene; layout and view are borrowed.
  ViewColumns(const FrameLayout& layout, const ViewTerms& view, const ViewState& pose, const FrameState& state,
              const Eigen::VectorXd& betas);

  /// Adds Mᵀ g and Mᵀ H M of a view's sums to those of the frame, with M = ∂(the view's columns)/∂(the layout's).
  void AddSums(const FrameSystem& in_view, FrameSystem* system) const;
  /// J M of rows of derivatives by the view's columns; `J` has the layout's columns.
  void TakeRows(const Eigen::Ref<const RowMatrixXd>& in_view, Eigen::Ref<RowMatrixXd> J) const;
  /// The layout's blocks for a group's blocks of the view (FrameLayout::num_blocks()), ascending.
  [[nodiscard]] std::vector<int> Blocks(const std::vector<int>& in_view) const;

 private:
  const FrameLayout& layout_;
  const ViewLayout& view_;
  std::optional<Eigen::Matrix3d> own_rotation_;        ///< P of a view that moves
  Eigen::Matrix3d rotation_;                           ///< R
  Eigen::Matrix<double, 6, 3> by_turn_;                ///< of (root rotation, translation) by ω
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_betas_;  ///< of the translation
  double clock_s_;
};

}  // namespace bodyloom
