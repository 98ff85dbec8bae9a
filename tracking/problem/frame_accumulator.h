// SPDX-License-Identifier: Apache-2.0
/// Accumulates a frame's terms: its cost and its normal equations, or its residuals one by one.
///
/// A term adds groups of residual rows with their derivatives, or its own sums of JᵀJ and Jᵀr. Rotations are
/// differentiated by right increments. Points that cannot be projected cost the kernel's saturation c² with a zero
/// derivative, and are counted. The mode determines the result:
///   kCost       ½ Σ w ρ(‖r‖²) only
///   kSums       the same, with gradient and Gauss–Newton matrix of the weighted residuals √(w ρ′) r
///   kRows       unweighted r and its derivatives, group by group, with their w and ρ, as Ceres takes them
///   kNorms      the same without derivatives; each group has the norm of its r in the first row
///   kStructure  as kRows, with the unknowns on which each group may depend
/// Holds scratch memory that is kept from frame to frame; one instance a thread.
#pragma once

#include <Eigen/Core>
#include <any>
#include <cmath>
#include <map>
#include <string>
#include <typeindex>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/robust.h"
#include "tracking/problem/visible_surface.h"

namespace ceres {
class LossFunction;
}  // namespace ceres

namespace bodyloom {

/// Gauss–Newton system of a frame: cost = ½ Σ ρ, gradient = Jᵀ r and H = Jᵀ J of the weighted residuals.
struct FrameSystem {
  double cost = 0;
  Eigen::MatrixXd H;  ///< lower triangle
  Eigen::VectorXd gradient;
  int num_invalid = 0;  ///< observations that could not be projected
};

/// Residuals of a term's observations in one frame, in pixels, before weights and kernels.
struct PixelResiduals {
  std::vector<double> px;
  int unmatched = 0;
};
/// Residuals by the term's name in the summary: "rendered UV", "silhouette", "part labels".
using FrameResiduals = std::map<std::string, PixelResiduals>;

/// Rows that share a robust kernel: ½ w ρ(‖r‖²).
struct ResidualGroup {
  int first_row = 0, num_rows = 0;
  double kernel = 0;  ///< c of Geman–McClure; 0: ρ(s) = s
  double weight = 1;
  ceres::LossFunction* loss = nullptr;  ///< ρ in place of the kernel; borrowed
  /// Unknowns that the rows may depend on at any state: FrameLayout::BlockOf… numbers, ascending. Filled in
  /// Mode::kStructure.
  std::vector<int> blocks;
};

class FrameAccumulator {
 public:
  enum class Mode { kCost, kSums, kNorms, kRows, kStructure };

  /// The surface point last evaluated in points(), and its projection.
  struct Projected {
    Eigen::Vector3d x;
    Eigen::Vector2d pixel;
    Matrix2x3d d_pixel_d_x;
  };

  /// Begins a frame at this state, all of which is borrowed until Finish(). `residuals` may be null.
  void Begin(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas, double log_focal,
             Mode mode, FrameResiduals* residuals);
  /// Allocates this many rows and clears the sums. To be called after Begin(), before the first term, in every mode but
  /// kCost.
  void ReserveRows(int rows);
  /// Sets the mode for the following terms; it may have derivatives only if that of Begin() has.
  void SetMode(Mode mode) { mode_ = mode; }
  /// Returns the sums of all terms added since ReserveRows(); H and gradient with derivatives only.
  void Finish(FrameSystem* system);

  [[nodiscard]] const FrameLayout& layout() const { return *layout_; }
  [[nodiscard]] const FrameState& state() const { return *state_; }
  [[nodiscard]] const Eigen::VectorXd& betas() const { return *betas_; }
  [[nodiscard]] double log_focal() const { return log_focal_; }
  [[nodiscard]] const Camera& camera() const { return camera_; }
  /// Time by which the observations of a view are moved (view_terms.h); to be set after Begin().
  void SetClockShift(double seconds) { clock_shift_s_ = seconds; }
  [[nodiscard]] double clock_shift_s() const { return clock_shift_s_; }
  [[nodiscard]] bool derivatives() const { return mode_ != Mode::kCost && mode_ != Mode::kNorms; }
  /// True if residuals are requested one by one; then rows must be added even if they are zero at this state.
  [[nodiscard]] bool one_by_one() const { return mode_ != Mode::kCost && mode_ != Mode::kSums; }
  [[nodiscard]] const Kinematics& kinematics() const { return kinematics_; }
  /// Evaluates points of the body; rows are added for the point evaluated last.
  PointEvaluator& points() { return points_; }
  PointEvaluator::VertexCache& vertices() { return vertices_; }
  VisibleSurface& surface() { return surface_; }
  /// Null if residuals are not requested.
  PixelResiduals* residuals(const char* name) { return residuals_ != nullptr ? &(*residuals_)[name] : nullptr; }
  /// Memory of one term's own, kept from frame to frame.
  template <typename T>
  T& Scratch() {
    std::any& scratch = scratch_[std::type_index(typeid(T))];
    if (!scratch.has_value()) scratch = std::make_shared<T>();
    return *std::any_cast<std::shared_ptr<T>&>(scratch);
  }

  [[nodiscard]] double cost() const { return cost_; }
  void AddCost(double cost) { cost_ += cost; }
  /// Adds the kernel's saturation for an observation, of num_rows rows of the point evaluated last, that cannot be
  /// used.
  void AddSaturated(double kernel, double weight, int num_rows = 2);
  bool Project(const Eigen::Vector3d& x, Projected* projected) {
    projected->x = x;
    return camera_.Project(x, &projected->pixel, derivatives() ? &projected->d_pixel_d_x : nullptr);
  }

  /// Adds ½ w ρ(‖r‖²) of a group of rows whose squared norm is given (kernel 0: ρ(s) = s) and returns the factor for
  /// its rows and residuals: √(w ρ′), or 1 if they are requested one by one.
  double AddGroup(int num_rows, double squared_norm, double kernel, double weight) {
    const RobustValue robust = kernel > 0 ? GemanMcClure(squared_norm, kernel) : RobustValue{squared_norm, 1};
    cost_ += 0.5 * weight * robust.rho;
    if (one_by_one()) {
      BeginGroup(num_rows, squared_norm, kernel, weight);
      return 1;
    }
    return std::sqrt(weight * robust.weight);
  }
  /// The same with a loss function, whose values ρ and ρ′ are given.
  double AddGroup(int num_rows, double squared_norm, double rho, double d_rho, ceres::LossFunction* loss);
  /// Adds ½ w ρ(‖residual‖²) with ∂residual/∂θ = B ∂pixel/∂θ of the point evaluated last; N rows. The residual falls by
  /// B `velocity` when the view's clock is moved by a second.
  template <int N>
  void AddImageRows(const Projected& at, const Eigen::Matrix<double, N, 1>& residual,
                    const Eigen::Matrix<double, N, 2>& B, double kernel, double weight,
                    const Eigen::Vector2d& velocity = Eigen::Vector2d::Zero());
  /// Adds ½ w ρ(‖W (π(x) − pixel − s velocity)‖²), x the point evaluated last and s the shift of the view's clock.
  void AddPixel(const Eigen::Vector3d& x, const Eigen::Vector2d& pixel, const Eigen::Matrix2d& whitening, double kernel,
                double weight, const Eigen::Vector2d& velocity = Eigen::Vector2d::Zero()) {
    Projected at;
    if (!Project(x, &at)) {
      AddSaturated(kernel, weight);
      return;
    }
    const Eigen::Vector2d residual = at.pixel - pixel - clock_shift_s_ * velocity;
    AddImageRows<2>(at, whitening * residual, whitening, kernel, weight, velocity);
  }
  /// The next `count` rows of the Jacobian and their residuals, to be filled before TakeRows(count); columns beyond the
  /// layout's are padding and stay zero.
  auto NextRows(int count) { return J_.middleRows(row_, count); }
  auto NextResiduals(int count) { return r_.segment(row_, count); }
  void TakeRows(int count) { row_ += count; }
  /// Fills 3×columns: the derivative of the point evaluated last, without translation.
  void FillPointRows(Eigen::Ref<RowMatrixXd> rows);
  /// Adds a group of N rows that depends on one joint (or on the translation), whose three columns begin at `column`:
  /// J and r multiplied by what AddGroup() returned. Summed as JᵀJ and Jᵀr, without rows.
  template <int N>
  void AddBlockRows(int column, const Eigen::Matrix<double, N, 3>& J, const Eigen::Matrix<double, N, 1>& r) {
    if (!one_by_one()) {
      H_.block<3, 3>(column, column) += J.transpose() * J;
      gradient_.segment<3>(column) += J.transpose() * r;
      return;
    }
    auto rows = NextRows(N);
    rows.setZero();
    rows.template middleCols<3>(column) = J;
    NextResiduals(N) = r;
    DependsOn(layout_->BlockOfColumn(column));
    TakeRows(N);
  }
  /// Upper triangle, row-major; columns padded. For terms that add their own sums, in Mode::kSums.
  RowMatrixXd& H() { return H_; }
  Eigen::VectorXd& gradient() { return gradient_; }

  /// Records unknowns on which the group begun last may depend: one of FrameLayout's blocks, or the joints that move
  /// the point evaluated last and the shape. FillPointRows(), AddImageRows() and AddBlockRows() call these themselves.
  void DependsOn(int block);
  void DependsOnPoint();

  /// Groups added since ReserveRows(), in the modes for residuals one by one, with their rows and residuals.
  [[nodiscard]] const std::vector<ResidualGroup>& groups() const { return groups_; }
  [[nodiscard]] const RowMatrixXd& rows() const { return J_; }
  [[nodiscard]] const Eigen::VectorXd& residual_values() const { return r_; }
  [[nodiscard]] int num_rows() const { return row_; }

  /// Approximate maximum number of observations used of a term with thousands in a frame, evenly chosen and weighted to
  /// represent all; 0: all.
  int max_points = 0;

 private:
  void BeginGroup(int num_rows, double squared_norm, double kernel, double weight);

  const FrameLayout* layout_ = nullptr;
  const FrameState* state_ = nullptr;
  const Eigen::VectorXd* betas_ = nullptr;
  double log_focal_ = 0, clock_shift_s_ = 0;
  FrameResiduals* residuals_ = nullptr;
  Mode mode_ = Mode::kCost;
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
  std::vector<ResidualGroup> groups_;
  std::map<std::type_index, std::any> scratch_;
};

template <int N>
void FrameAccumulator::AddImageRows(const Projected& at, const Eigen::Matrix<double, N, 1>& residual,
                                    const Eigen::Matrix<double, N, 2>& B, double kernel, double weight,
                                    const Eigen::Vector2d& velocity) {
  const FrameLayout& layout = *layout_;
  const double scale = AddGroup(N, residual.squaredNorm(), kernel, weight);
  if (!derivatives()) return;
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
  if (layout.clock_column >= 0) rows.col(layout.clock_column) = -by_pixel * velocity;
  r_.segment<N>(row_) = scale * residual;
  row_ += N;
  if (mode_ == Mode::kStructure) {
    DependsOnPoint();
    DependsOn(layout.TranslationBlock());
    DependsOn(layout.FocalBlock());
    DependsOn(layout.ClockBlock());
  }
}

}  // namespace bodyloom
