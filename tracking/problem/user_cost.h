// SPDX-License-Identifier: Apache-2.0
/// Users' cost functions (user_term.h) in a clip's problem: those of one frame as terms of its list, those of several
/// frames as couplings.
///   cost += ½ ρ(s),  H += ρ′(s) JᵀJ,  g += ρ′(s) Jᵀr,  s = ‖r‖²,  J = ∂r/∂blocks · ∂blocks/∂unknowns
/// ∂blocks/∂unknowns: of a landmark or a surface point that of geometry/body/surface_jacobian.h (and of
/// FrameLayout::BodyPlace), of a rotation's nine numbers ∂vec(R exp δ)/∂δ, of translation and betas the identity, of
/// the focal length f ∂f/∂log f = f. Joints that are held give zeros. This is the Gauss–Newton approximation, without
/// the loss's second derivative.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/math/arrays.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/frame_term.h"
#include "tracking/problem/user_term.h"

namespace bodyloom {

/// Inputs of a term, compiled for a body.
struct CompiledInputs {
  struct Input {
    TermInput::Kind kind;
    int frame = 0;              ///< index into the frames that are read
    std::vector<int> vertices;  ///< of a landmark or surface point, with their weights
    std::vector<double> weights;
    int joint = -1;
    int size = 3;
  };
  std::string term;
  std::vector<int> later;  ///< of the frames that are read: ascending, the first 0
  std::vector<Input> inputs;
};

/// After CheckUserTerm(). Throws std::invalid_argument when the term reads betas and none are estimated.
std::shared_ptr<const CompiledInputs> CompileInputs(const UserTerm& term, const BodyModel& model, int num_betas);

/// One cost function with its inputs.
struct UserCost {
  std::shared_ptr<const CompiledInputs> inputs;
  std::shared_ptr<const ceres::CostFunction> function;
  std::shared_ptr<ceres::LossFunction> loss;
};

/// The residual before the loss, and its derivative.
struct UserResidual {
  bool valid = false;
  Eigen::VectorXd r;
  RowMatrixXd J;            ///< columns: each frame's num_frame_columns(), then the shared ones of the layout
  std::vector<char> reads;  ///< by unknown block in the same order: the residual may depend on it at some state
};

/// Evaluates a cost function. `states`: of the frames that are read, in their order. Fills `result->J` and `reads` only
/// with derivatives.
void EvaluateUserCost(const UserCost& cost, const FrameLayout& layout, std::span<const FrameState* const> states,
                      const Eigen::VectorXd& betas, double log_focal, bool derivatives, UserResidual* result);

/// ρ(s) and ρ′(s); without a loss s and 1.
struct LossValue {
  double rho = 0, weight = 1;
};
LossValue EvaluateLoss(const UserCost& cost, double s);

/// A user's cost function of one frame as an entry of the frame's list.
class UserCostTerm : public CopyableTerm<UserCostTerm> {
 public:
  UserCostTerm() = default;
  explicit UserCostTerm(UserCost cost) : cost_(std::move(cost)) {}

  [[nodiscard]] std::string name() const override { return cost_.inputs == nullptr ? "" : cost_.inputs->term; }
  [[nodiscard]] int num_rows() const override;
  void Add(FrameAccumulator* sums) const override;
  [[nodiscard]] const UserCost& cost() const { return cost_; }

 private:
  UserCost cost_;
};

/// A user's cost function of several frames.
struct FrameCoupling {
  UserCost cost;
  std::vector<int> frames;  ///< of the problem, ascending
};

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct SequenceProblem;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// Adds the cost functions of every term to the problem, whose frames, cuts and layout must be set. Throws
/// std::invalid_argument, in one line that names term and frame, for CheckUserTerm()'s reasons and when the parameter
/// blocks of a cost function do not have the sizes of the term's inputs.
void AddUserTerms(std::span<const UserTerm> terms, SequenceProblem* problem);
/// The cost function of frame t of a term of one frame, or null. `inputs` are CompileInputs() of the term.
std::unique_ptr<FrameTerm> MakeUserCostTerm(const UserTerm& term, const std::shared_ptr<const CompiledInputs>& inputs,
                                            int t);
/// One entry a term.
std::vector<PlanEntry> PlanUserTerms(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeUserTerms(const ClipTermInput& clip);

}  // namespace bodyloom
