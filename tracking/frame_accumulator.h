// SPDX-License-Identifier: Apache-2.0
/// Sums of a frame's terms: its cost and its normal equations.
///
/// A term hands over rows of residuals and Jacobian, or squares of blocks that it knows itself. Rotations are
/// differentiated by right increments. Points that cannot be projected cost the kernel's saturation c² with a zero
/// derivative, and are counted. Holds scratch memory that is kept from frame to frame; one instance a thread.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/frame_layout.h"
#include "bodyloom/tracking/kinematics.h"
#include "bodyloom/tracking/robust.h"
#include "bodyloom/tracking/terms/dense/dense_points.h"
#include "bodyloom/tracking/visible_surface.h"

namespace bodyloom {

/// Gauss–Newton system of a frame: cost = ½ Σ ρ, gradient = Jᵀ r and H = Jᵀ J of the weighted residuals.
struct FrameSystem {
  double cost = 0;
  Eigen::MatrixXd H;  ///< lower triangle
  Eigen::VectorXd gradient;
  int num_invalid = 0;  ///< observations that could not be projected
};

/// How far the newer image terms are off in one frame, in pixels, before weights and kernels.
struct FrameResiduals {
  std::vector<double> rendered_uv_px, silhouette_px, part_px;
  int rendered_uv_unmatched = 0, silhouette_unmatched = 0, part_unmatched = 0;
};

class FrameAccumulator {
 public:
  /// A surface point that was evaluated last in points(), and where it appears.
  struct Projected {
    Eigen::Vector3d x;
    Eigen::Vector2d pixel;
    Matrix2x3d d_pixel_d_x;
  };

  /// Begins a frame at this state, all of which is borrowed until Finish(). Without `derivatives` only the cost is
  /// added up. `residuals` may be null.
  void Begin(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas, double log_focal,
             bool derivatives, FrameResiduals* residuals);
  /// Makes room for this many rows; with derivatives, before the first term.
  void ReserveRows(int rows);
  /// The sums of all that was added since Begin(); H and gradient with derivatives only.
  void Finish(FrameSystem* system);

  [[nodiscard]] const FrameLayout& layout() const { return *layout_; }
  [[nodiscard]] const FrameState& state() const { return *state_; }
  [[nodiscard]] const Eigen::VectorXd& betas() const { return *betas_; }
  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] bool derivatives() const { return derivatives_; }
  [[nodiscard]] const Kinematics& kinematics() const { return kinematics_; }
  /// Evaluates points of the body; what was evaluated last is what rows are added for.
  PointEvaluator& points() { return points_; }
  PointEvaluator::VertexCache& vertices() { return vertices_; }
  VisibleSurface& surface() { return surface_; }
  /// Null where nobody wants to know.
  FrameResiduals* residuals() { return residuals_; }

  void AddCost(double cost) { cost_ += cost; }
  /// An observation that could not be used costs its kernel's saturation.
  void AddSaturated(double kernel, double weight) {
    cost_ += 0.5 * weight * kernel * kernel;
    ++num_invalid_;
  }
  bool Project(const Eigen::Vector3d& x, Projected* projected) {
    projected->x = x;
    return camera_.Project(x, &projected->pixel, derivatives_ ? &projected->d_pixel_d_x : nullptr);
  }
  /// ½ w ρ(‖residual‖²) with ∂residual/∂θ = B ∂pixel/∂θ of the point evaluated last; N rows.
  template <int N>
  void AddImageRows(const Projected& at, const Eigen::Matrix<double, N, 1>& residual,
                    const Eigen::Matrix<double, N, 2>& B, double kernel, double weight);
  /// ½ w ρ(‖W (π(x) − pixel)‖²), x the point evaluated last.
  void AddPixel(const Eigen::Vector3d& x, const Eigen::Vector2d& pixel, const Eigen::Matrix2d& whitening, double kernel,
                double weight) {
    Projected at;
    if (!Project(x, &at)) {
      AddSaturated(kernel, weight);
      return;
    }
    AddImageRows<2>(at, whitening * (at.pixel - pixel), whitening, kernel, weight);
  }
  /// The next `count` rows of the Jacobian and their residuals, to be filled before TakeRows(count); columns beyond the
  /// layout's are padding and stay zero.
  auto NextRows(int count) { return J_.middleRows(row_, count); }
  auto NextResiduals(int count) { return r_.segment(row_, count); }
  void TakeRows(int count) { row_ += count; }
  /// 3×columns: derivative of the point evaluated last, without translation.
  void FillPointRows(Eigen::Ref<RowMatrixXd> rows);
  /// Adds JᵀJ and Jᵀr of a term that depends on one joint (or on the translation): three columns.
  void AddSquares(int column, const Eigen::Matrix3d& JtJ, const Eigen::Vector3d& Jtr) {
    H_.block<3, 3>(column, column) += JtJ;
    gradient_.segment<3>(column) += Jtr;
  }
  /// Upper triangle by rows; columns padded.
  RowMatrixXd& H() { return H_; }
  Eigen::VectorXd& gradient() { return gradient_; }

  /// At most about this many dense keypoints of a frame, evenly chosen and weighted to stand for all; 0: all.
  int max_dense = 0;
  // Scratch of single terms.
  DensePoints dense_points;
  std::vector<DensePoints::Row> dense_rows;
  std::vector<char> has_dense_row;
  RowMatrixXd hip_rows;

 private:
  const FrameLayout* layout_ = nullptr;
  const FrameState* state_ = nullptr;
  const Eigen::VectorXd* betas_ = nullptr;
  FrameResiduals* residuals_ = nullptr;
  bool derivatives_ = false;
  Kinematics kinematics_;
  PointEvaluator points_;
  PointEvaluator::VertexCache vertices_;
  VisibleSurface surface_;
  Camera camera_;
  RowMatrixXd J_;  ///< rows of the terms that are not added directly; columns padded with zeros
  Eigen::VectorXd r_;
  RowMatrixXd H_;  ///< upper triangle; columns padded
  Eigen::VectorXd gradient_;
  int row_ = 0;
  double cost_ = 0;
  int num_invalid_ = 0;
};

template <int N>
void FrameAccumulator::AddImageRows(const Projected& at, const Eigen::Matrix<double, N, 1>& residual,
                                    const Eigen::Matrix<double, N, 2>& B, double kernel, double weight) {
  const FrameLayout& layout = *layout_;
  const RobustValue robust = GemanMcClure(residual.squaredNorm(), kernel);
  cost_ += 0.5 * weight * robust.rho;
  if (!derivatives_) return;
  const double scale = std::sqrt(weight * robust.weight);
  const Eigen::Matrix<double, N, 2> by_pixel = scale * B;
  const Eigen::Matrix<double, N, 3> A = by_pixel * at.d_pixel_d_x;
  auto rows = J_.middleRows<N>(row_);
  rows.setZero();
  for (int j : points_.joints()) {
    const int column = layout.column_of_joint[j];
    if (column >= 0) rows.template middleCols<3>(column).noalias() = A * points_.JointJacobian(kinematics_, j);
  }
  if (layout.knowledge == CameraKnowledge::kWeak) {
    const Eigen::Matrix<double, N, 2> by_offset = camera_.scale * by_pixel;
    rows.col(layout.translation_column) = by_offset * Eigen::Vector2d(at.x.x() + camera_.tx, at.x.y() + camera_.ty);
    rows.col(layout.translation_column + 1) = by_offset.col(0);
    rows.col(layout.translation_column + 2) = by_offset.col(1);
  } else {
    rows.template middleCols<3>(layout.translation_column) = A;
  }
  if (layout.num_betas > 0) {
    rows.middleCols(layout.beta_column, layout.num_betas).noalias() = A * points_.ShapeJacobian();
  }
  if (layout.focal_column >= 0) {
    rows.col(layout.focal_column) = by_pixel * (at.pixel - Eigen::Vector2d(camera_.cx, camera_.cy));
  }
  r_.segment<N>(row_) = scale * residual;
  row_ += N;
}

}  // namespace bodyloom
