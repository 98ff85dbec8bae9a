// SPDX-License-Identifier: Apache-2.0
#include "tracking/chain/chain_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Borrows an evaluator for one frame. Which one does not matter: they hold scratch memory only.
class ChainProblem::Lease {
 public:
  explicit Lease(ChainProblem* owner) : owner_(owner) {
    const std::lock_guard<std::mutex> lock(owner_->evaluators_mutex_);
    if (owner_->evaluators_.empty()) return;
    evaluator_ = std::move(owner_->evaluators_.back());
    owner_->evaluators_.pop_back();
  }
  ~Lease() {
    const std::lock_guard<std::mutex> lock(owner_->evaluators_mutex_);
    owner_->evaluators_.push_back(std::move(evaluator_));
  }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;
  FrameEvaluator& operator*() {
    if (evaluator_ == nullptr) evaluator_ = std::make_unique<FrameEvaluator>();
    return *evaluator_;
  }

 private:
  ChainProblem* owner_;
  std::unique_ptr<FrameEvaluator> evaluator_;
};

ChainProblem::ChainProblem(const SequenceProblem& problem, bool shape_constant, bool focal_constant, int num_threads)
    : problem_(problem),
      n_(problem.layout.num_frame_columns()),
      blocks_(n_ / 3),
      num_threads_(num_threads),
      shape_constant_(shape_constant || problem.layout.num_betas == 0),
      focal_constant_(focal_constant || problem.layout.focal_column < 0) {
  const FrameLayout& layout = problem.layout;
  const size_t T = problem.states.size();
  systems_.resize(T);
  for (int b = 0; b < layout.num_betas && !shape_constant_; ++b) shared_columns_.push_back(layout.beta_column + b);
  if (!focal_constant_) shared_columns_.push_back(layout.focal_column);
  if (layout.num_betas > 0) ShapePriorRows(problem, &shape_prior_, &shape_offset_);
  const std::vector<double> levers = JointLevers(*layout.model);
  for (int j : layout.active_joints) {
    inverse_sigma_.emplace_back(Eigen::Array3d::Constant(levers[j] / problem.smoothness.tip_acceleration));
  }
  const std::array<double, 3> root_sigma = RootAccelerationSigma(problem);
  inverse_sigma_.emplace_back(1 / root_sigma[0], 1 / root_sigma[1], 1 / root_sigma[2]);
  factors_.resize(T);
  for (size_t t = 2; t < T; ++t) {
    if (!HasAcceleration(t)) continue;
    factors_[t] = AccelerationFactors::Of(problem.timestamps[t - 1] - problem.timestamps[t - 2],
                                          problem.timestamps[t] - problem.timestamps[t - 1]);
  }
  changes_.resize(T);
  costs_.resize(T);
  next_.resize(T * 3 * n_);
  second_.resize(T * 3 * n_);
  own_.resize(T * 3 * n_);
}

bool ChainProblem::HasAcceleration(size_t t) const {
  return t >= 2 && t < systems_.size() && !problem_.cut_before[t] && !problem_.cut_before[t - 1];
}

double ChainProblem::EvaluateFrames(const ChainPoint& point, bool derivatives) {
  const int T = static_cast<int>(point.states.size());
  ParallelFor(T, num_threads_, [&](int t) {
    Lease evaluator(this);
    (*evaluator).LimitDense(max_dense_);
    (*evaluator)
        .Evaluate(problem_.layout, problem_.frames[t], point.states[t], point.betas, point.log_focal, derivatives,
                  &systems_[t]);
    costs_[t] = systems_[t].cost;
  });
  double sum = 0;
  for (int t = 0; t < T; ++t) sum += costs_[t];
  return sum;
}

double ChainProblem::EvaluateChanges(const ChainPoint& point, bool derivatives) {
  const int T = static_cast<int>(point.states.size());
  const std::vector<int>& joints = problem_.layout.active_joints;
  ParallelFor(T, num_threads_, [&](int t) {
    // The change that ends at t has a part in the accelerations that end at t and at t + 1.
    if (t == 0 || !(HasAcceleration(t) || HasAcceleration(t + 1))) return;
    Change& change = changes_[t];
    change.step.resize(blocks_);
    if (derivatives) change.right.resize(joints.size());
    for (size_t a = 0; a < joints.size(); ++a) {
      change.step[a] = AxisAngleFromRotation(point.states[t - 1].rotations[joints[a]].transpose() *
                                             point.states[t].rotations[joints[a]]);
      if (derivatives) change.right[a] = RightJacobianInverse(change.step[a]);
    }
    change.step[joints.size()] = point.states[t].translation - point.states[t - 1].translation;
  });
  double sum = 0;
  for (int t = 2; t < T; ++t) {
    if (!HasAcceleration(t)) continue;
    const AccelerationFactors& f = factors_[t];
    for (int a = 0; a < blocks_; ++a) {
      sum += 0.5 * (inverse_sigma_[a] * (f.later * changes_[t].step[a] - f.earlier * changes_[t - 1].step[a]).array())
                       .square()
                       .sum();
    }
  }
  return sum;
}

double ChainProblem::SharedCost(const ChainPoint& point) const {
  double cost = 0;
  if (problem_.layout.num_betas > 0) cost += 0.5 * (shape_prior_ * point.betas + shape_offset_).squaredNorm();
  if (problem_.layout.focal_column >= 0) {
    const double r = (point.log_focal - problem_.log_focal_prior) / problem_.log_focal_sigma;
    cost += 0.5 * r * r;
  }
  return cost;
}

double ChainProblem::Cost(const ChainPoint& point) {
  return EvaluateFrames(point, false) + EvaluateChanges(point, false) + SharedCost(point);
}

void ChainProblem::AddSharedPriors(const ChainPoint& point) {
  int at = 0;
  if (!shape_constant_) {
    at = problem_.layout.num_betas;
    shared_.topLeftCorner(at, at) += shape_prior_.transpose() * shape_prior_;
    shared_gradient_.head(at) += shape_prior_.transpose() * (shape_prior_ * point.betas + shape_offset_);
  }
  if (!focal_constant_) {
    const double information = 1 / (problem_.log_focal_sigma * problem_.log_focal_sigma);
    shared_(at, at) += information;
    shared_gradient_[at] += information * (point.log_focal - problem_.log_focal_prior);
  }
}

void ChainProblem::AssembleAcceleration(size_t t) {
  double* own = &own_[t * 3 * n_];
  double* next = &next_[t * 3 * n_];
  double* second = &second_[t * 3 * n_];
  std::fill(own, own + 3 * n_, 0.0);
  std::fill(next, next + 3 * n_, 0.0);
  std::fill(second, second + 3 * n_, 0.0);
  for (size_t end = t; end <= t + 2; ++end) {  // frame t is the last, the middle or the first of these three
    if (!HasAcceleration(end)) continue;
    const size_t role = t + 2 - end;  // 2, 1, 0: its place in (end − 2, end − 1, end)
    const AccelerationFactors& f = factors_[end];
    const Change &first = changes_[end - 1], &last = changes_[end];
    for (int a = 0; a < blocks_; ++a) {
      Matrix3d J[3];
      if (a + 1 < blocks_) {
        RotationAccelerationJacobians(f, first.right[a], last.right[a], J);
      } else {
        J[0] = f.earlier * Matrix3d::Identity();
        J[1] = -(f.earlier + f.later) * Matrix3d::Identity();
        J[2] = f.later * Matrix3d::Identity();
      }
      const Eigen::Array3d weight = inverse_sigma_[a].square();
      const Vector3d r = (weight * (f.later * last.step[a] - f.earlier * first.step[a]).array()).matrix();
      const Matrix3d weighted = J[role].transpose() * weight.matrix().asDiagonal();
      gradient_.segment<3>(static_cast<Eigen::Index>(t * n_ + 3 * a)) += J[role].transpose() * r;
      Eigen::Map<RowMatrix3d>(own + 9 * a) += weighted * J[role];
      if (role < 2) Eigen::Map<RowMatrix3d>(next + 9 * a) += weighted * J[role + 1];
      if (role == 0) Eigen::Map<RowMatrix3d>(second + 9 * a) += weighted * J[2];
    }
  }
}

double ChainProblem::Linearise(const ChainPoint& point) {
  const int T = static_cast<int>(point.states.size()), s = shared_size();
  const double cost = EvaluateFrames(point, true) + EvaluateChanges(point, true) + SharedCost(point);
  gradient_.resize(static_cast<Eigen::Index>(T) * n_);
  diagonal_.resize(gradient_.size());
  ParallelFor(T, num_threads_, [&](int t) {
    const auto offset = static_cast<Eigen::Index>(t) * n_;
    gradient_.segment(offset, n_) = systems_[t].gradient.head(n_);
    AssembleAcceleration(t);
    for (int i = 0; i < n_; ++i) {
      diagonal_[offset + i] = systems_[t].H(i, i) + own_[static_cast<size_t>(offset) * 3 + i / 3 * 9 + i % 3 * 4];
    }
  });
  shared_.setZero(s, s);
  shared_gradient_.setZero(s);
  for (int t = 0; t < T; ++t) {
    for (int i = 0; i < s; ++i) {
      shared_gradient_[i] += systems_[t].gradient[shared_columns_[i]];
      for (int j = 0; j <= i; ++j) shared_(i, j) += systems_[t].H(shared_columns_[i], shared_columns_[j]);
    }
  }
  AddSharedPriors(point);
  return cost;
}

void ChainProblem::AddFrame(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const {
  const FrameSystem& system = systems_[t];
  const auto offset = static_cast<Eigen::Index>(t) * n_;
  const double* own = &own_[static_cast<size_t>(offset) * 3];
  const int s = shared_size();
  for (int i = 0; i < n_; ++i) {
    // The lower triangle by columns is the upper one by rows.
    const double* column = system.H.data() + i * system.H.rows();
    double* row = a + i * a_stride;
    for (int j = i; j < n_; ++j) row[j] += column[j];
    for (int j = i; j < i / 3 * 3 + 3; ++j) row[j] += own[i / 3 * 9 + i % 3 * 3 + j % 3];
    row[i] += (*damping_)[offset + i];
    double* arrow = b + i * b_stride;
    for (int j = 0; j < s; ++j) arrow[j] += column[shared_columns_[j]];
    arrow[s] -= gradient_[offset + i];
  }
}

void ChainProblem::Plus(const ChainPoint& x, const VectorXd& step, const VectorXd& shared_step, ChainPoint* y) const {
  const std::vector<int>& joints = problem_.layout.active_joints;
  *y = x;
  ParallelFor(static_cast<int>(x.states.size()), num_threads_, [&](int t) {
    FrameState& state = y->states[t];
    Eigen::Index at = static_cast<Eigen::Index>(t) * n_;
    for (int j : joints) {
      const Matrix3d R = state.rotations[j] * RotationFromAxisAngle(step.segment<3>(at));
      // Products of many rotations would drift: one Newton step towards the nearest rotation ends that.
      state.rotations[j] = 0.5 * R * (3 * Matrix3d::Identity() - R.transpose() * R);
      at += 3;
    }
    state.translation += step.segment<3>(at);
  });
  int at = 0;
  if (!shape_constant_) {
    at = problem_.layout.num_betas;
    y->betas += shared_step.head(at);
  }
  if (!focal_constant_) y->log_focal += shared_step[at];
}

double ChainProblem::SquaredNorm(const ChainPoint& x) const {
  double sum = x.betas.squaredNorm() + x.log_focal * x.log_focal;
  for (const FrameState& state : x.states) {
    sum += state.translation.squaredNorm();
    for (int j : problem_.layout.active_joints) sum += AxisAngleFromRotation(state.rotations[j]).squaredNorm();
  }
  return sum;
}

}  // namespace bodyloom
