// SPDX-License-Identifier: Apache-2.0
/// Users' own cost functions of one frame (own_term.h) in the frame's normal equations.
///   cost += ½ ρ(s),  H += ρ′(s) JᵀJ,  g += ρ′(s) Jᵀr,  s = ‖r‖²,  J = ∂r/∂blocks · ∂blocks/∂unknowns
/// ∂blocks/∂unknowns: of a landmark that of body_points.h (and of FrameLayout::BodyPlace), of a rotation's nine numbers
/// ∂vec(R exp δ)/∂δ, of the translation the identity. Joints that are held give zeros. Gauss–Newton as everywhere: the
/// loss's second derivative is left out.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/tracking/body_points.h"
#include "bodyloom/tracking/frame_layout.h"
#include "bodyloom/tracking/terms/own/own_term.h"

namespace bodyloom {

class FrameAccumulator;

/// What a term reads of a frame, compiled for a body.
struct OwnBlocks {
  int term = 0;  ///< index into TrackSequenceOptions::own_terms
  std::vector<CompiledPoint> points;
  bool translation = false;
  std::vector<int> joints;
};

/// One cost function with what it reads.
struct OwnCost {
  std::shared_ptr<const OwnBlocks> blocks;
  std::shared_ptr<const ceres::CostFunction> function;
  std::shared_ptr<ceres::LossFunction> loss;
};

/// The landmarks that a term reads, in its order; after CheckOwnTerm().
std::vector<CompiledPoint> CompileOwnLandmarks(const OwnTerm& term, const BodyModel& model, int num_betas);

struct OwnCostsOfFrame {
  std::vector<OwnCost> costs;      ///< on this frame alone
  std::vector<OwnCost> with_next;  ///< on this frame and the next one (neighbours_cost.h); not a part of Add()

  [[nodiscard]] int num_rows() const;
  void Add(FrameAccumulator* sums) const;
};

/// ρ(s) and ρ′(s); without a loss s and 1.
struct OwnLoss {
  double rho = 0, weight = 1;
};
OwnLoss EvaluateOwnLoss(const OwnCost& cost, double s);

/// ½ ρ(s) of one cost function at a state; NaN when it cannot be evaluated.
double OwnCostAt(const OwnCost& cost, const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas);

/// o of x + o, the position of a point in the camera frame, with x relative to what the kinematics hold (zero unless
/// the camera is weak), and its derivative by the translation's three columns.
Eigen::Vector3d OwnOrigin(const FrameLayout& layout, const FrameState& state, Eigen::Matrix3d* d_origin);

}  // namespace bodyloom
