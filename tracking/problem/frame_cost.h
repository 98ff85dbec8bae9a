// SPDX-License-Identifier: Apache-2.0
/// The cost of one frame: everything that depends on one frame's pose and on the clip's shape and focal length. It is
/// the sum over the terms of the frame's list (TermList), each of which is explained in its own header; the built-in
/// ones are listed in term_kinds.h.
///
/// Other cameras that show the same person add their terms likewise (view_terms.h).
///
/// For a moving camera the state is in the scene. It is transformed to the camera frame for the terms, and their sums
/// are transformed back to the scene (moving_camera.h).
///
/// Rotations are differentiated by right increments. Points that cannot be projected cost the kernel's saturation c²
/// with a zero derivative, and are counted.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/frame_term.h"
#include "tracking/problem/view_terms.h"

namespace bodyloom {

/// The ground under a person: {x : up · x = level_m}, in the frame of the states.
struct FrameGround {
  Eigen::Vector3d up = Eigen::Vector3d(0, -1, 0);  ///< unit
  double level_m = 0;
  Eigen::Vector3d measured_up = Eigen::Vector3d(0, -1, 0);  ///< the vertical without what touches the ground, unit
  double measured_up_sigma_rad = 0;                         ///< its σ per direction across it
  /// σ of up, per direction across it, and of level_m for this vertical.
  double up_sigma_rad = 0, level_sigma_m = 0;
  double depth_sigma_m = 0.12;  ///< of what touches it, along the ray of the first view
  /// Variance of the plane's height above x by what touched it: x · P x − 2 q · x + s. Zero where it is given.
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  Eigen::Vector3d q = Eigen::Vector3d::Zero();
  double s = 0;
  [[nodiscard]] double HeightVariance(const Eigen::Vector3d& x) const {
    return std::max(0.0, x.dot(P * x) - 2 * q.dot(x) + s);
  }
};

/// The terms of one frame, and its camera pose if the camera moves. Borrowed pointers outlive the cost.
struct FrameData {
  /// Pose of a moving camera: the frame's state is in the scene, and its terms are in this camera's frame
  /// (moving_camera.h). Null: the camera is static.
  const CameraPose* camera_from_scene = nullptr;
  FrameGround* ground = nullptr;  ///< of the frame's shot, as last estimated (terms/ground_contact); null: not known
  TermList terms;
  std::vector<ViewTerms> views;  ///< terms of the other views that show this frame

  /// As of TermList.
  template <typename Term>
  Term& Get() {
    return terms.Get<Term>();
  }
  template <typename Term>
  [[nodiscard]] const Term& Get() const {
    return terms.Get<Term>();
  }
  /// Calls f(term, view) for the terms of the list, with view −1, then for those of the other views.
  template <typename Function>
  void ForEachTerm(const Function& f) const {
    for (const auto& term : terms) f(term.get(), -1);
    for (const ViewTerms& view : views) {
      for (const auto& term : view.terms) f(term.get(), view.view);
    }
  }
};

/// The term's name in the table of costs; of another view (its index) with ", view 2" and so on.
std::string NameOfTerm(const FrameTerm& term, int view);

/// A frame's residuals one by one: the groups of rows of its terms, in the order of FrameData::ForEachTerm(). A
/// compressed term (FrameTerm::is_compressed) is one group of CompressedRows().
struct FrameRows {
  RowMatrixXd J;  ///< by the columns of the layout
  Eigen::VectorXd r;
  std::vector<ResidualGroup> groups;
  std::vector<int> term_of_group;  ///< index in that order
  bool is_finite = false;
};

/// Fills p + 2 rows J and r equivalent to a cost with these normal equations, p its columns: R δ + y with RᵀR = H and
/// y = R⁻ᵀ g; one row for the part of g outside the range of Rᵀ, where H is not positive definite to rounding; and the
/// square root of the remaining cost, with a zero derivative, which includes the part of robust kernels that is not in
/// the weighted residuals. Cost, gradient and Gauss–Newton step are those of the system. Without derivatives everything
/// is in the last row.
void CompressedRows(const FrameSystem& system, bool derivatives, Eigen::Ref<RowMatrixXd> J,
                    Eigen::Ref<Eigen::VectorXd> r);

/// Evaluates frames; holds scratch memory, one instance a thread.
class FrameEvaluator {
 public:
  /// Limits the observations used of a term with thousands in a frame to about this many, evenly chosen and weighted to
  /// represent all; 0: all. Frames with rendered UV always use all.
  void LimitPoints(int max_points) { sums_.max_points = max_points; }
  /// Evaluates the sums; only the cost when `derivatives` is false. If given, `residuals` is appended to and
  /// `term_costs` is filled with the cost of each term, in the order of FrameData::ForEachTerm().
  void Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state, const SharedValues& shared,
                bool derivatives, FrameSystem* system, FrameResiduals* residuals = nullptr,
                std::vector<double>* term_costs = nullptr);
  /// Evaluates the residuals one by one. `mode`: kNorms, kRows, or kStructure, which fills ResidualGroup::blocks.
  /// Number and structure of the groups do not depend on the state.
  void EvaluateRows(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                    const SharedValues& shared, FrameAccumulator::Mode mode, FrameRows* rows);

 private:
  void Begin(const FrameLayout& layout, const FrameData& data, const FrameState& state, const SharedValues& shared,
             FrameAccumulator::Mode mode, FrameResiduals* residuals);
  /// Begins a view of the frame and returns the derivatives of its columns.
  ViewColumns BeginView(const FrameLayout& layout, const ViewTerms& view, const FrameState& state,
                        const SharedValues& shared, FrameAccumulator::Mode mode, FrameResiduals* residuals);
  void AppendCompressed(int term, const FrameLayout& layout, const FrameData& data, bool derivatives, FrameRows* rows);
  void AppendGroups(int term, const FrameLayout& layout, const FrameData& data, FrameRows* rows);
  void AppendRowsOfView(int first_term, const ViewTerms& view, const ViewColumns& columns, FrameAccumulator::Mode mode,
                        FrameRows* rows);

  FrameAccumulator sums_, view_sums_;
  FrameState in_camera_;  ///< of a camera that moves
  FrameState in_view_;
  FrameSystem system_, view_system_;
};

/// Computes upper triangular R with RᵀR = H (lower triangle of H is read) and y with Rᵀy = g, for positive
/// semi-definite H with g in its range; pivots below 1e-14 of the largest diagonal give zero rows.
void SquareRootSystem(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, Eigen::MatrixXd* R, Eigen::VectorXd* y);

}  // namespace bodyloom
