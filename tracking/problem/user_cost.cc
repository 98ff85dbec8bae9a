// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/user_cost.h"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/surface_jacobian.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Kind = TermInput::Kind;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// "3, 3, 9"
std::string SizesText(const std::vector<int>& sizes) {
  std::string text;
  for (const int size : sizes) text += (text.empty() ? "" : ", ") + std::to_string(size);
  return text.empty() ? "none" : text;
}

/// Fills the values of the inputs and, with derivatives, their derivatives by the unknowns.
class InputReader {
 public:
  InputReader(const FrameLayout& layout, std::span<const FrameState* const> states, const VectorXd& betas,
              double log_focal, UserResidual* result)
      : layout_(layout),
        states_(states),
        betas_(betas),
        log_focal_(log_focal),
        result_(result),
        bodies_(states.size()) {
    shared_column_ = static_cast<int>(states.size()) * layout.num_frame_columns();
    shared_block_ = static_cast<int>(states.size()) * (layout.TranslationBlock() + 1);
  }

  /// `d_value` has no columns if derivatives are not requested.
  void Read(const CompiledInputs::Input& input, double* value, Eigen::Ref<RowMatrixXd> d_value) {
    const bool derivatives = d_value.cols() > 0;
    const FrameState& state = *states_[input.frame];
    const int n = layout_.num_frame_columns(), first = input.frame * n, B = layout_.num_betas;
    switch (input.kind) {
      case Kind::kLandmark:
      case Kind::kSurfacePoint: {
        const PointJacobian point = BodyOf(input.frame).OfVertices(input.vertices, input.weights);
        const bool weak = layout_.knowledge == CameraKnowledge::kWeak;
        Eigen::Map<Vector3d> at(value);
        at = weak ? Vector3d(point.point + layout_.BodyPlace(state)) : point.point;
        if (!derivatives) return;
        for (size_t i = 0; i < point.joints.size(); ++i) {
          const int column = layout_.column_of_joint[point.joints[i]];
          if (column < 0) continue;
          d_value.middleCols<3>(first + column) = point.d_point_d_rotation[i];
          Reads(input.frame, FrameLayout::BlockOfColumn(column));
        }
        d_value.middleCols<3>(first + layout_.translation_column) = layout_.BodyPlaceByTranslation(state);
        Reads(input.frame, layout_.TranslationBlock());
        if (B == 0) return;
        d_value.middleCols(shared_column_, B) = point.d_point_d_betas;
        result_->reads[shared_block_] = 1;
        return;
      }
      case Kind::kRotation: {
        const Matrix3d& R = state.rotations[input.joint];
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> entries(value);
        entries = R;
        const int column = layout_.column_of_joint[input.joint];
        if (!derivatives || column < 0) return;
        d_value.middleCols<3>(first + column) = EntriesByIncrement(R);
        Reads(input.frame, FrameLayout::BlockOfColumn(column));
        return;
      }
      case Kind::kTranslation:
        std::copy(state.translation.data(), state.translation.data() + 3, value);
        if (!derivatives) return;
        d_value.middleCols<3>(first + layout_.translation_column).setIdentity();
        Reads(input.frame, layout_.TranslationBlock());
        return;
      case Kind::kBetas:
        std::copy(betas_.data(), betas_.data() + B, value);
        if (!derivatives) return;
        d_value.middleCols(shared_column_, B).setIdentity();
        result_->reads[shared_block_] = 1;
        return;
      case Kind::kFocalLength: {
        const bool estimated = layout_.focal_column >= 0;
        *value = estimated ? std::exp(log_focal_) : layout_.camera.fx;
        if (!derivatives || !estimated) return;
        d_value(0, shared_column_ + B) = *value;
        result_->reads.back() = 1;
        return;
      }
    }
  }

 private:
  const SurfaceJacobian& BodyOf(int frame) {
    std::optional<SurfaceJacobian>& body = bodies_[frame];
    if (!body) {
      const FrameState& state = *states_[frame];
      body.emplace(*layout_.model, betas_, BodyPose{state.rotations, layout_.BodyTranslation(state)});
    }
    return *body;
  }
  void Reads(int frame, int block) { result_->reads[frame * (layout_.TranslationBlock() + 1) + block] = 1; }

  const FrameLayout& layout_;
  std::span<const FrameState* const> states_;
  const VectorXd& betas_;
  double log_focal_;
  UserResidual* result_;
  std::vector<std::optional<SurfaceJacobian>> bodies_;
  int shared_column_, shared_block_;
};

}  // namespace

std::shared_ptr<const CompiledInputs> CompileInputs(const UserTerm& term, const BodyModel& model, int num_betas) {
  CheckUserTerm(term, model);
  auto compiled = std::make_shared<CompiledInputs>();
  compiled->term = term.name;
  compiled->later = {0};
  for (const TermInput& input : term.inputs) compiled->later.push_back(input.later);
  std::sort(compiled->later.begin(), compiled->later.end());
  compiled->later.erase(std::unique(compiled->later.begin(), compiled->later.end()), compiled->later.end());
  for (const TermInput& given : term.inputs) {
    CompiledInputs::Input& input = compiled->inputs.emplace_back();
    input.kind = given.kind;
    input.joint = given.joint;
    const auto at = std::lower_bound(compiled->later.begin(), compiled->later.end(), given.later);
    input.frame = static_cast<int>(at - compiled->later.begin());
    if (given.kind == Kind::kLandmark) {
      const Landmark& landmark = model.data().landmarks[model.FindLandmark(given.landmark)];
      input.vertices = landmark.vertices;
      input.weights = landmark.weights;
    } else if (given.kind == Kind::kSurfacePoint) {
      for (int c = 0; c < 3; ++c) {
        input.vertices.push_back(model.data().faces(given.point.face, c));
        input.weights.push_back(given.point.barycentric[c]);
      }
    } else if (given.kind == Kind::kRotation) {
      input.size = 9;
    } else if (given.kind == Kind::kBetas) {
      BODYLOOM_CHECK(num_betas > 0, "term '", term.name, "': reads the shape, which is not estimated");
      input.size = num_betas;
    } else if (given.kind == Kind::kFocalLength) {
      input.size = 1;
    }
  }
  return compiled;
}

LossValue EvaluateLoss(const UserCost& cost, double s) {
  if (cost.loss == nullptr) return {s, 1};
  double rho[3];
  cost.loss->Evaluate(s, rho);
  return {rho[0], std::max(0.0, rho[1])};
}

void EvaluateUserCost(const UserCost& cost, const FrameLayout& layout, std::span<const FrameState* const> states,
                      const VectorXd& betas, double log_focal, bool derivatives, UserResidual* result) {
  const CompiledInputs& compiled = *cost.inputs;
  const bool has_focal = layout.focal_column >= 0;
  const int columns =
      static_cast<int>(states.size()) * layout.num_frame_columns() + layout.num_columns - layout.beta_column;
  int size = 0;
  for (const CompiledInputs::Input& input : compiled.inputs) size += input.size;
  VectorXd values(size);
  RowMatrixXd d_values;
  d_values.setZero(size, derivatives ? columns : 0);
  result->reads.assign(states.size() * (layout.TranslationBlock() + 1) + (layout.num_betas > 0) + has_focal, 0);
  InputReader reader(layout, states, betas, log_focal, result);
  const int num_residuals = cost.function->num_residuals();
  std::vector<const double*> parameters;
  std::vector<RowMatrixXd> by_block;
  std::vector<double*> jacobians;
  int row = 0;
  for (const CompiledInputs::Input& input : compiled.inputs) {
    reader.Read(input, &values[row], d_values.middleRows(row, input.size));
    parameters.push_back(&values[row]);
    if (derivatives) by_block.emplace_back(num_residuals, input.size);
    row += input.size;
  }
  for (RowMatrixXd& block : by_block) jacobians.push_back(block.data());
  result->r.resize(num_residuals);
  result->valid =
      cost.function->Evaluate(parameters.data(), result->r.data(), derivatives ? jacobians.data() : nullptr) &&
      result->r.allFinite();
  if (!derivatives) return;
  result->J.setZero(num_residuals, columns);
  row = 0;
  for (size_t b = 0; result->valid && b < by_block.size(); ++b) {
    result->J.noalias() += by_block[b] * d_values.middleRows(row, by_block[b].cols());
    row += static_cast<int>(by_block[b].cols());
  }
}

int UserCostTerm::num_rows() const { return cost_.function == nullptr ? 0 : cost_.function->num_residuals(); }

void UserCostTerm::Add(FrameAccumulator* sums) const {
  const FrameLayout& layout = sums->layout();
  const FrameState* state = &sums->state();
  UserResidual& residual = sums->Scratch<UserResidual>();
  EvaluateUserCost(cost_, layout, {&state, 1}, sums->betas(), sums->log_focal(), sums->derivatives(), &residual);
  const auto count = static_cast<int>(residual.r.size());
  if (!residual.valid) sums->AddCost(kNaN);
  const double s = residual.r.squaredNorm();
  const LossValue loss = residual.valid ? EvaluateLoss(cost_, s) : LossValue{};
  const double scale = sums->AddGroup(count, s, loss.rho, loss.weight, cost_.loss.get());
  if (!sums->derivatives()) return;
  auto rows = sums->NextRows(count);
  rows.setZero();
  rows.leftCols(layout.num_columns) = scale * residual.J;
  sums->NextResiduals(count) = scale * residual.r;
  for (size_t block = 0; block < residual.reads.size(); ++block) {
    if (residual.reads[block] != 0) sums->DependsOn(static_cast<int>(block));
  }
  sums->TakeRows(count);
}

namespace {

UserCost CheckedCost(const UserTerm& term, const std::shared_ptr<const CompiledInputs>& inputs, int t) {
  std::shared_ptr<const ceres::CostFunction> function = term.cost(t);
  if (function == nullptr) return {};
  std::vector<int> expected;
  for (const CompiledInputs::Input& input : inputs->inputs) expected.push_back(input.size);
  BODYLOOM_CHECK(function->parameter_block_sizes() == expected && function->num_residuals() > 0, "term '", term.name,
                 "', frame ", t, ": ", function->num_residuals(), " residuals on parameter blocks of ",
                 SizesText(function->parameter_block_sizes()), "; expected blocks of ", SizesText(expected));
  return {inputs, std::move(function), term.loss};
}

}  // namespace

void AddUserTerms(std::span<const UserTerm> terms, SequenceProblem* problem) {
  const int T = static_cast<int>(problem->frames.size());
  for (const UserTerm& term : terms) {
    const auto inputs = CompileInputs(term, *problem->layout.model, problem->layout.num_betas);
    const int reach = inputs->later.back();
    for (int t = 0; t + reach < T; ++t) {
      const auto first = problem->cut_before.begin() + t + 1;
      if (!term.across_cuts && std::any_of(first, first + reach, [](char cut) { return cut != 0; })) continue;
      UserCost cost = CheckedCost(term, inputs, t);
      if (cost.function == nullptr) continue;
      if (reach == 0) {
        problem->frames[t].terms.Add(std::make_unique<UserCostTerm>(std::move(cost)));
        continue;
      }
      FrameCoupling& coupling = problem->couplings.emplace_back();
      coupling.cost = std::move(cost);
      for (const int later : inputs->later) coupling.frames.push_back(t + later);
    }
  }
}

std::unique_ptr<FrameTerm> MakeUserCostTerm(const UserTerm& term, const std::shared_ptr<const CompiledInputs>& inputs,
                                            int t) {
  UserCost cost = CheckedCost(term, inputs, t);
  return cost.function == nullptr ? nullptr : std::make_unique<UserCostTerm>(std::move(cost));
}

std::unique_ptr<ClipTerm> MakeUserTerms(const ClipTermInput& clip) {
  class UserTerms : public ClipTerm {
   public:
    explicit UserTerms(const std::vector<UserTerm>& terms) : terms_(terms) {}
    void Observe(SequenceProblem* problem) override { AddUserTerms(terms_, problem); }

   private:
    const std::vector<UserTerm>& terms_;
  };
  return std::make_unique<UserTerms>(clip.options.user_terms);
}

std::vector<PlanEntry> PlanUserTerms(const TrackSequenceInput& /*input*/, const TrackSequenceOptions& options) {
  std::vector<PlanEntry> plan;
  for (const UserTerm& term : options.user_terms) {
    plan.push_back({"term '" + term.name + "'", true,
                    term.is_of_one_frame() ? "of one frame at a time" : "couples frames of its own choice"});
  }
  return plan;
}

}  // namespace bodyloom
