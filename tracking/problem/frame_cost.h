// SPDX-License-Identifier: Apache-2.0
/// The cost of one frame: everything that depends on one frame's pose and on the clip's shape and focal length. It is
/// the sum over the terms of the frame's list (frame_cost.h), each of which has its law in its own header; the built-in
/// ones are those of term_kinds.h.
///
/// Where the camera moves, the state is in the scene and every term takes it in the camera frame of its frame; the sums
/// are taken back to the scene at the end (moving_camera.h).
///
/// Rotations are differentiated by right increments. Points that cannot be projected cost the kernel's saturation c²
/// with a zero derivative, and are counted.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/scene/camera.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

// The terms of one frame, and its camera where that moves. Borrowed pointers outlive the cost.

struct FrameData {
  /// Of a camera that moves: a frame's state is in the scene, and its terms speak of this camera's frame
  /// (moving_camera.h). Null: the camera stands still.
  const CameraPose* camera_from_scene = nullptr;
  TermList terms;

  /// As of TermList.
  template <typename Term>
  Term& Get() {
    return terms.Get<Term>();
  }
  template <typename Term>
  [[nodiscard]] const Term& Get() const {
    return terms.Get<Term>();
  }
};

/// A frame's residuals one by one: the groups of rows of its terms, in the order of the list. What a term compresses
/// (FrameTerm::is_compressed) comes as one group of CompressedRows().
struct FrameRows {
  RowMatrixXd J;  ///< by the columns of the layout
  Eigen::VectorXd r;
  std::vector<ResidualGroup> groups;
  std::vector<int> term_of_group;  ///< index into the frame's list
  bool is_finite = false;
};

/// p + 2 rows that stand for a cost with these normal equations, p its columns: R δ + y with RᵀR = H and y = R⁻ᵀ g; one
/// that carries what R leaves out of g where H is not positive definite to rounding; and √(what is missing from cost),
/// with a zero derivative, which also holds the part of robust kernels that weighted residuals do not show. Cost,
/// gradient and Gauss–Newton step are those of the system. Without derivatives everything is in the last row. J and r:
/// p + 2 rows.
void CompressedRows(const FrameSystem& system, bool derivatives, Eigen::Ref<RowMatrixXd> J,
                    Eigen::Ref<Eigen::VectorXd> r);

/// Evaluates frames; holds scratch memory, one instance a thread.
class FrameEvaluator {
 public:
  /// From now on at most about this many observations of a term of thousands in a frame, evenly chosen and weighted to
  /// stand for all of them; 0: all. Frames with rendered UV always use all.
  void LimitPoints(int max_points) { sums_.max_points = max_points; }
  /// Cost only when `derivatives` is false. `residuals` is filled when given (appended to), `term_costs` with the cost
  /// of each term of the list.
  void Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state, const Eigen::VectorXd& betas,
                double log_focal, bool derivatives, FrameSystem* system, FrameResiduals* residuals = nullptr,
                std::vector<double>* term_costs = nullptr);
  /// The residuals one by one. `mode`: kNorms, kRows, or kStructure, which fills ResidualGroup::blocks. How many groups
  /// there are and what their structure is does not depend on the state.
  void EvaluateRows(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                    const Eigen::VectorXd& betas, double log_focal, FrameAccumulator::Mode mode, FrameRows* rows);

 private:
  void Begin(const FrameLayout& layout, const FrameData& data, const FrameState& state, const Eigen::VectorXd& betas,
             double log_focal, FrameAccumulator::Mode mode, FrameResiduals* residuals);
  void AppendCompressed(int term, const FrameLayout& layout, const FrameData& data, bool derivatives, FrameRows* rows);
  void AppendGroups(int term, const FrameLayout& layout, const FrameData& data, FrameRows* rows);

  FrameAccumulator sums_;
  FrameState in_camera_;  ///< of a camera that moves
  FrameSystem system_;
};

/// Upper triangular R with RᵀR = H (lower triangle of H is read) and y with Rᵀy = g, for positive semi-definite H with
/// g in its range; pivots below 1e-14 of the largest diagonal give zero rows.
void SquareRootSystem(const Eigen::MatrixXd& H, const Eigen::VectorXd& g, Eigen::MatrixXd* R, Eigen::VectorXd* y);

}  // namespace bodyloom
