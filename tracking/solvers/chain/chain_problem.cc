// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain/chain_problem.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/panel_simd.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {
/// Maximum change for which a frame's quadratic model is reused: radians, metres, log focal length.
constexpr double kFarthestSkip = 0.05;
/// Approximate displacement of a point of the surface by a unit of a shape component.
constexpr double kMetresPerBeta = 0.03;
/// Information of an unconstrained frame when it is eliminated: a σ of a thousand radians or metres.
constexpr double kNothing = 1e-6;
}  // namespace

struct ChainProblem::Scratch {
  FrameEvaluator evaluator;
  FrameSystem system;
};

/// Borrows an evaluator for one frame. Any will do, since they hold only scratch memory.
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
  Scratch& operator*() {
    if (evaluator_ == nullptr) evaluator_ = std::make_unique<Scratch>();
    return *evaluator_;
  }

 private:
  ChainProblem* owner_;
  std::unique_ptr<Scratch> evaluator_;
};

ChainProblem::~ChainProblem() = default;

void ChainProblem::PackedSystem::Pack(const FrameSystem& system, bool with_gradient) {
  size = system.H.rows();
  triangle.resize(static_cast<size_t>(size * (size + 1) / 2));
  double* to = triangle.data();
  for (Eigen::Index i = 0; i < size; ++i) to = std::copy_n(system.H.data() + i * size + i, size - i, to);
  if (with_gradient) gradient = system.gradient;
}

void ChainProblem::PackedSystem::UnpackTo(Eigen::MatrixXd* H) const {
  H->resize(size, size);
  const double* from = triangle.data();
  for (Eigen::Index i = 0; i < size; from += size - i, ++i) {
    std::copy_n(from, size - i, H->data() + i * size + i);
  }
}

ChainProblem::ChainProblem(const SequenceProblem& problem, bool shape_constant, bool focal_constant, int num_threads)
    : problem_(problem),
      n_(problem.layout.num_frame_columns()),
      blocks_(n_ / 3),
      num_threads_(num_threads),
      shape_constant_(shape_constant || problem.layout.num_betas == 0),
      focal_constant_(focal_constant || problem.layout.focal_column < 0) {
  const FrameLayout& layout = problem.layout;
  for (int b = 0; b < layout.num_betas && !shape_constant_; ++b) shared_columns_.push_back(layout.beta_column + b);
  for (int column = layout.beta_column + layout.num_betas; column < layout.num_columns; ++column) {
    if (column != layout.focal_column || !focal_constant_) shared_columns_.push_back(column);
  }
  for (size_t shot = 0; shot < problem.smoothness.size(); ++shot) {
    std::vector<Eigen::Array3d>& inverse = inverse_sigma_.emplace_back();
    const std::vector<double> joint_sigma = JointAccelerationSigma(problem, static_cast<int>(shot));
    for (int j : layout.active_joints) inverse.emplace_back(Eigen::Array3d::Constant(1 / joint_sigma[j]));
    const std::array<double, 3> root_sigma = RootAccelerationSigma(problem, static_cast<int>(shot));
    inverse.emplace_back(1 / root_sigma[0], 1 / root_sigma[1], 1 / root_sigma[2]);
  }
  if (problem.velocity_weight > 0) {
    const std::vector<double> joint_sigma = JointVelocitySigma(problem);
    for (int j : layout.active_joints)
      inverse_velocity_sigma_.emplace_back(Eigen::Array3d::Constant(1 / joint_sigma[j]));
    const std::array<double, 3> root_sigma = RootVelocitySigma(problem);
    inverse_velocity_sigma_.emplace_back(1 / root_sigma[0], 1 / root_sigma[1], 1 / root_sigma[2]);
  }
  Resize();
}

void ChainProblem::Resize() {
  linearised_ = false;
  const size_t T = problem_.states.size();
  if (inverse_sigma_.size() > 1) shot_ = ShotOfFrames(problem_.cut_before);
  if (problem_.layout.num_betas > 0) ShapePriorRows(problem_, &shape_prior_, &shape_offset_);
  systems_.resize(T);
  anchors_.resize(T);
  skipped_.resize(T);
  frame_gradient_.resize(T);
  factors_.resize(T);
  for (size_t t = 2; t < T; ++t) {
    if (!HasAcceleration(t)) continue;
    factors_[t] = AccelerationFactors::Of(problem_.timestamps[t - 1] - problem_.timestamps[t - 2],
                                          problem_.timestamps[t] - problem_.timestamps[t - 1]);
  }
  changes_.resize(T);
  frozen_.clear();
  costs_.resize(T);
  acceleration_costs_.resize(T);
  velocity_costs_.resize(T);
  ResizeCouplings();
  next_.resize(T * 3 * n_);
  second_.resize(T * 3 * n_);
  own_.resize(T * 3 * n_);
}

void ChainProblem::Moved(int dropped) {
  // Frames keep their systems; the memory of removed frames is reused for new ones.
  std::rotate(systems_.begin(), systems_.begin() + dropped, systems_.end());
  std::rotate(anchors_.begin(), anchors_.begin() + dropped, anchors_.end());
  const size_t kept = systems_.size() - static_cast<size_t>(dropped);
  for (size_t t = kept; t < anchors_.size(); ++t) anchors_[t].set = false;
  Resize();
}

void ChainProblem::SetPrior(const ChainPrior* prior) {
  BODYLOOM_CHECK(prior == nullptr || (couplings_.empty() && problem_.layout.views.empty()),
                 "chain: a prior beside cost functions on several frames or several views");
  prior_ = prior;
  linearised_ = false;
}

void ChainProblem::LimitPoints(int max_points) {
  if (max_points != max_points_) {
    for (Anchor& anchor : anchors_) anchor.set = false;
    linearised_ = false;
  }
  max_points_ = max_points;
}

bool ChainProblem::StepsFrom(const Anchor& anchor, const FrameState& state, const ChainPoint& point,
                             VectorXd* d) const {
  d->resize(n_ + shared_size());
  const auto fits = [](const auto& x) { return x.cwiseAbs().maxCoeff() <= kFarthestSkip; };  // false for NaN
  d->segment<3>(n_ - 3) = state.translation - anchor.state.translation;
  if (!fits(d->segment<3>(n_ - 3))) return false;
  const FrameLayout& layout = problem_.layout;
  const VectorXd shared = SharedStep(layout, anchor.shared, point);
  for (int i = 0; i < shared_size(); ++i) {
    const int column = shared_columns_[i] - layout.beta_column;
    const double unit = column < layout.num_betas ? kMetresPerBeta : 1;
    (*d)[n_ + i] = shared[column];
    if (!(std::abs(unit * shared[column]) <= kFarthestSkip)) return false;
  }
  int at = 0;
  for (int j : problem_.layout.active_joints) {
    d->segment<3>(at) = AxisAngleFromRotation(anchor.state.rotations[j].transpose() * state.rotations[j]);
    if (!fits(d->segment<3>(at))) return false;
    at += 3;
  }
  return true;
}

void ChainProblem::SetFrozen(std::vector<char> frozen) {
  if (frozen.empty() && frozen_.empty()) return;
  BODYLOOM_CHECK(frozen.empty() || (linearised_ && prior_ == nullptr && frozen.size() == systems_.size()),
                 "chain: frozen marks for ", frozen.size(), " of ", systems_.size(),
                 " frames, expected all of them, linearised, without a prior");
  frozen_ = std::move(frozen);
  if (frozen_.empty() && linearised_) SumShared(linearised_at_);
}

bool ChainProblem::AllFrozen(int64_t first, int64_t last) const {
  if (frozen_.empty()) return false;
  last = std::min(last, static_cast<int64_t>(frozen_.size()) - 1);
  for (int64_t t = std::max<int64_t>(0, first); t <= last; ++t) {
    if (frozen_[t] == 0) return false;
  }
  return true;
}

double ChainProblem::EvaluateFrames(const ChainPoint& point, bool derivatives) {
  const int T = static_cast<int>(point.states.size()), s = shared_size();
  ParallelFor(T, num_threads_, [&](int t) {
    PackedSystem& system = systems_[t];
    Anchor& anchor = anchors_[t];
    VectorXd d;
    skipped_[t] = IsFrozen(t) ? 1 : 0;
    if (IsFrozen(t)) return;
    Lease lease(this);
    auto& [evaluator, evaluated] = *lease;
    if (reuse_share_ > 0 && anchor.set && StepsFrom(anchor, point.states[t], point, &d)) {
      system.UnpackTo(&evaluated.H);
      VectorXd full = VectorXd::Zero(system.gradient.size());
      full.head(n_) = d.head(n_);
      for (int i = 0; i < s; ++i) full[shared_columns_[i]] = d[n_ + i];
      const VectorXd Hd = evaluated.H.selfadjointView<Eigen::Lower>() * full;
      const double moved = 0.5 * full.dot(Hd);
      if (moved <= reuse_share_ * reuse_share_ * anchor.cost) {
        skipped_[t] = 1;
        costs_[t] = anchor.cost + system.gradient.dot(full) + moved;
        if (derivatives) frame_gradient_[t] = system.gradient + Hd;
        return;
      }
    }
    evaluator.LimitPoints(max_points_);
    evaluator.Evaluate(problem_.layout, problem_.frames[t], point.states[t], point, derivatives, &evaluated);
    costs_[t] = evaluated.cost;
    if (!derivatives) return;
    system.Pack(evaluated, reuse_share_ > 0);
    frame_gradient_[t] = evaluated.gradient;
    anchor.set = reuse_share_ > 0 && std::isfinite(evaluated.cost);
    if (!anchor.set) return;
    anchor.state = point.states[t];
    anchor.shared = point;
    anchor.cost = evaluated.cost;
  });
  num_skipped_ = static_cast<int>(std::count(skipped_.begin(), skipped_.end(), 1));
  double sum = 0;
  for (int t = 0; t < T; ++t) sum += costs_[t];
  return sum;
}

double ChainProblem::SharedCost(const ChainPoint& point) const {
  double cost = 0;
  if (problem_.layout.num_betas > 0) cost += 0.5 * (shape_prior_ * point.betas + shape_offset_).squaredNorm();
  for (const SharedPrior& prior : SharedPriors(problem_, point)) {
    const double r = (prior.value - prior.mean) / prior.sigma;
    cost += 0.5 * r * r;
  }
  return cost;
}

double ChainProblem::Cost(const ChainPoint& point) {
  linearised_ = false;
  const double cost =
      EvaluateFrames(point, false) + EvaluateChanges(point, false) + EvaluatePrior(point, false) + SharedCost(point);
  return couplings_.empty() ? cost : cost + EvaluateCouplings(point, false);
}

std::ptrdiff_t ChainProblem::SharedIndexOf(int column) const {
  const auto found = std::lower_bound(shared_columns_.begin(), shared_columns_.end(), column);
  return found == shared_columns_.end() || *found != column ? -1 : found - shared_columns_.begin();
}

void ChainProblem::AddSharedPriors(const ChainPoint& point) {
  if (!shape_constant_) {
    const int B = problem_.layout.num_betas;
    shared_.topLeftCorner(B, B) += shape_prior_.transpose() * shape_prior_;
    shared_gradient_.head(B) += shape_prior_.transpose() * (shape_prior_ * point.betas + shape_offset_);
  }
  for (const SharedPrior& prior : SharedPriors(problem_, point)) {
    const double information = 1 / (prior.sigma * prior.sigma);
    const auto add = [&](std::ptrdiff_t i, double sign) {
      if (i < 0) return;
      shared_(i, i) += information;
      shared_gradient_[i] += sign * information * (prior.value - prior.mean);
    };
    const std::ptrdiff_t i = SharedIndexOf(prior.column), j = SharedIndexOf(prior.minus_column);
    add(i, 1);
    add(j, -1);
    if (i >= 0 && j >= 0) {
      shared_(i, j) -= information;
      shared_(j, i) -= information;
    }
  }
}

double ChainProblem::EvaluatePrior(const ChainPoint& point, bool derivatives) {
  if (prior_ == nullptr) return 0;
  const int s = shared_size(), size = 2 * n_ + s;
  BODYLOOM_CHECK(point.states.size() >= 2 && prior_->M.rows() == size && prior_->m.size() == size, "chain: a prior of ",
                 prior_->M.rows(), " values on ", point.states.size(), " frames of ", n_, " and ", s,
                 " shared values; expected ", size, " on two frames or more");
  VectorXd e(size);
  std::vector<Matrix3d> right;
  int at = 0;
  for (int k = 0; k < 2; ++k) {
    for (int j : problem_.layout.active_joints) {
      e.segment<3>(at) =
          AxisAngleFromRotation(prior_->states[k].rotations[j].transpose() * point.states[k].rotations[j]);
      if (derivatives) right.push_back(RightJacobianInverse(e.segment<3>(at)));
      at += 3;
    }
    e.segment<3>(at) = point.states[k].translation - prior_->states[k].translation;
    if (derivatives) right.push_back(Matrix3d::Identity());
    at += 3;
  }
  if (!shape_constant_) {
    e.segment(at, point.betas.size()) = point.betas - prior_->betas;
    at += static_cast<int>(point.betas.size());
  }
  if (!focal_constant_) e[at] = point.log_focal - prior_->log_focal;
  const VectorXd Me = prior_->M * e;
  const double cost = e.dot(0.5 * Me + prior_->m);
  if (!derivatives) return cost;
  prior_gradient_ = prior_->m + Me;
  prior_matrix_ = prior_->M;
  // RᵀMR = ((MR)ᵀR)ᵀ, symmetric: columns both times, which lie together in memory.
  for (int pass = 0; pass < 2; ++pass) {
    for (size_t i = 0; i < right.size(); ++i) {
      const auto b = static_cast<Eigen::Index>(3 * i);
      prior_matrix_.middleCols<3>(b) = (prior_matrix_.middleCols<3>(b) * right[i]).eval();
    }
    prior_matrix_.transposeInPlace();
  }
  for (size_t i = 0; i < right.size(); ++i) {
    const auto b = static_cast<Eigen::Index>(3 * i);
    prior_gradient_.segment<3>(b) = (right[i].transpose() * prior_gradient_.segment<3>(b)).eval();
  }
  prior_next_ = prior_matrix_.block(0, n_, n_, n_);
  return cost;
}

void ChainProblem::AddPrior() {
  if (prior_ == nullptr) return;
  const int s = shared_size();
  gradient_.head(2 * n_) += prior_gradient_.head(2 * n_);
  diagonal_.head(2 * n_) += prior_matrix_.diagonal().head(2 * n_);
  shared_gradient_ += prior_gradient_.tail(s);
  shared_ += prior_matrix_.bottomRightCorner(s, s);
}

bool ChainProblem::IsLinearisedAt(const ChainPoint& point) const {
  const auto same = [](const FrameState& a, const FrameState& b) {
    return a.rotations == b.rotations && a.translation == b.translation;
  };
  const auto same_view = [](const ViewState& a, const ViewState& b) {
    const CameraPose &p = a.camera_from_scene, &q = b.camera_from_scene;
    return p.camera_from_world_rotation == q.camera_from_world_rotation &&
           p.camera_from_world_translation == q.camera_from_world_translation && a.log_focal == b.log_focal &&
           a.offset_s == b.offset_s && a.rate == b.rate;
  };
  return linearised_ && point.log_focal == linearised_at_.log_focal && point.betas == linearised_at_.betas &&
         std::equal(point.views.begin(), point.views.end(), linearised_at_.views.begin(), linearised_at_.views.end(),
                    same_view) &&
         std::equal(point.states.begin(), point.states.end(), linearised_at_.states.begin(),
                    linearised_at_.states.end(), same);
}

void ChainProblem::SumShared(const ChainPoint& point) {
  const int T = static_cast<int>(systems_.size()), s = shared_size();
  shared_.setZero(s, s);
  shared_gradient_.setZero(s);
  for (int t = 0; t < T; ++t) {
    for (int i = 0; i < s; ++i) {
      shared_gradient_[i] += frame_gradient_[t][shared_columns_[i]];
      for (int j = 0; j <= i; ++j) shared_(i, j) += systems_[t].H(shared_columns_[i], shared_columns_[j]);
    }
  }
  far_shared_diagonal_.setZero(s);
  SumSharedOfCouplings();
  AddSharedPriors(point);
}

double ChainProblem::Linearise(const ChainPoint& point) {
  if (IsLinearisedAt(point)) return linearised_cost_;
  const int T = static_cast<int>(point.states.size());
  double cost =
      EvaluateFrames(point, true) + EvaluateChanges(point, true) + EvaluatePrior(point, true) + SharedCost(point);
  if (!couplings_.empty()) cost += EvaluateCouplings(point, true);
  gradient_.resize(static_cast<Eigen::Index>(T) * n_);
  diagonal_.resize(gradient_.size());
  ParallelFor(T, num_threads_, [&](int t) {
    const auto offset = static_cast<Eigen::Index>(t) * n_;
    if (AllFrozen(t - 2, t + 2)) return;
    gradient_.segment(offset, n_) = frame_gradient_[t].head(n_);
    AssembleAcceleration(t);
    if (problem_.velocity_weight > 0) AssembleVelocity(t);
    for (int i = 0; i < n_; ++i) {
      diagonal_[offset + i] = systems_[t].H(i, i) + own_[static_cast<size_t>(offset) * 3 + i / 3 * 9 + i % 3 * 4];
    }
    if (!couplings_.empty()) AssembleCouplings(t);
  });
  if (frozen_.empty()) SumShared(point);
  AddPrior();
  linearised_ = true;
  linearised_at_ = point;
  linearised_cost_ = cost;
  return cost;
}

bool ChainProblem::Marginalise(const ChainPoint& point, ChainPrior* prior) const {
  using panel_internal::RoundUp;
  const int T = static_cast<int>(point.states.size()), s = shared_size(), size = 2 * n_ + s;
  BODYLOOM_CHECK(T >= 3, "chain: ", T, " frames, expected three or more to take the first away");
  BODYLOOM_CHECK(couplings_.empty(), "chain: a frame that a cost function couples to others cannot be taken away");
  BODYLOOM_CHECK(problem_.velocity_weight <= 0, "chain: a frame whose velocity costs something cannot be taken away");
  // Frame 0's rows: [A | C D B | right-hand side].
  const int x_begin = RoundUp(n_), x_columns = RoundUp(size + 1);
  const int64_t stride = panel_internal::RowStride(x_begin + x_columns);
  std::vector<double> panel(static_cast<size_t>(n_ * stride), 0.0);
  // Rows of the remaining unknowns; the right-hand side is the last column.
  const int64_t left_stride = panel_internal::RowStride(size + 1);
  std::vector<double> left(static_cast<size_t>((size + 1) * left_stride), 0.0);
  using Rows = Eigen::Map<RowMatrixXd, 0, Eigen::OuterStride<>>;
  Rows A(panel.data(), n_, x_columns + x_begin, Eigen::OuterStride<>(stride));
  Rows N(left.data(), size + 1, size + 1, Eigen::OuterStride<>(left_stride));
  Rows X(panel.data() + x_begin, n_, x_columns, Eigen::OuterStride<>(stride));

  const PackedSystem& system = systems_[0];
  Eigen::MatrixXd H;
  system.UnpackTo(&H);
  A.leftCols(n_) = H.topLeftCorner(n_, n_).selfadjointView<Eigen::Lower>();
  A.diagonal().array() += kNothing;
  for (int i = 0; i < s; ++i) {
    X.col(2 * n_ + i) = H.row(shared_columns_[i]).head(n_).transpose();
    N(2 * n_ + i, size) = -frame_gradient_[0][shared_columns_[i]];
    for (int j = 0; j <= i; ++j) {
      N(2 * n_ + i, 2 * n_ + j) = N(2 * n_ + j, 2 * n_ + i) = H(shared_columns_[i], shared_columns_[j]);
    }
  }
  X.col(size) = -gradient_.head(n_);
  if (HasAcceleration(2)) {
    for (int a = 0; a < blocks_; ++a) {
      Matrix3d J[3];
      Eigen::Array3d weight;
      Vector3d force;
      AccelerationOf(2, a, J, &weight, &force);
      const auto product = [&](int i, int j) -> Matrix3d {
        return J[i].transpose() * weight.matrix().asDiagonal() * J[j];
      };
      A.block<3, 3>(3 * a, 3 * a) += product(0, 0);
      for (int i = 1; i < 3; ++i) {
        const int row = (i - 1) * n_ + 3 * a;
        X.block<3, 3>(3 * a, row) += product(0, i);
        N.block<3, 1>(row, size) -= J[i].transpose() * force;
        for (int j = 1; j < 3; ++j) N.block<3, 3>(row, (j - 1) * n_ + 3 * a) += product(i, j);
      }
    }
  }
  if (prior_ != nullptr) {
    A.leftCols(n_) += prior_matrix_.topLeftCorner(n_, n_);
    X.leftCols(n_) += prior_matrix_.block(0, n_, n_, n_);
    X.middleCols(2 * n_, s) += prior_matrix_.block(0, 2 * n_, n_, s);
    N.topLeftCorner(n_, n_) += prior_matrix_.block(n_, n_, n_, n_);
    N.block(0, 2 * n_, n_, s) += prior_matrix_.block(n_, 2 * n_, n_, s);
    N.block(2 * n_, 0, s, n_) += prior_matrix_.block(2 * n_, n_, s, n_);
    N.block(2 * n_, 2 * n_, s, s) += prior_matrix_.bottomRightCorner(s, s);
    N.col(size).head(n_) -= prior_gradient_.segment(n_, n_);
    N.col(size).segment(2 * n_, s) -= prior_gradient_.tail(s);
  }
  if (!panel_internal::EliminateRows(panel.data(), stride, n_, x_columns, false)) return false;
  panel_internal::Products products;
  products.a = products.b = X.data();
  products.c = left.data();
  products.lda = products.ldb = stride;
  products.ldc = left_stride;
  products.rows = size;
  products.columns = size + 1;
  products.last = n_;
  products.upper = true;
  products.sign = -1;
  panel_internal::AddProducts(products);
  ChainPrior result;
  result.set = true;
  result.states = {point.states[1], point.states[2]};
  result.betas = point.betas;
  result.log_focal = point.log_focal;
  result.M = N.topLeftCorner(size, size).selfadjointView<Eigen::Upper>();
  result.m = -N.col(size).head(size);
  if (!result.M.allFinite() || !result.m.allFinite()) return false;
  *prior = std::move(result);
  return true;
}

void ChainProblem::AddFrame(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const {
  const PackedSystem& system = systems_[t];
  const auto offset = static_cast<Eigen::Index>(t) * n_;
  const double* own = &own_[static_cast<size_t>(offset) * 3];
  const int s = shared_size();
  for (int i = 0; i < n_; ++i) {
    // The lower triangle by columns is the upper one by rows.
    const double* column = system.Column(i);
    double* row = a + i * a_stride;
    for (int j = i; j < n_; ++j) row[j] += column[j];
    for (int j = i; j < i / 3 * 3 + 3; ++j) row[j] += own[i / 3 * 9 + i % 3 * 3 + j % 3];
    row[i] += (*damping_)[offset + i];
    double* arrow = b + i * b_stride;
    for (int j = 0; j < s; ++j) arrow[j] += column[shared_columns_[j]];
    if (prior_ != nullptr && t < 2) {
      const auto p = prior_matrix_.col(offset + i);  // symmetric
      for (int j = i; j < n_; ++j) row[j] += p[offset + j];
      for (int j = 0; j < s; ++j) arrow[j] += p[2 * n_ + j];
    }
    arrow[arrow_size()] -= gradient_[offset + i];
  }
  if (!couplings_.empty()) AddCouplings(t, a, a_stride, b, b_stride);
}

void ChainProblem::Plus(const ChainPoint& x, const VectorXd& step, const VectorXd& shared_step, ChainPoint* y) const {
  const std::vector<int>& joints = problem_.layout.active_joints;
  *y = x;
  ParallelFor(static_cast<int>(x.states.size()), num_threads_, [&](int t) {
    if (IsFrozen(t)) return;
    FrameState& state = y->states[t];
    Eigen::Index at = static_cast<Eigen::Index>(t) * n_;
    for (int j : joints) {
      state.rotations[j] = NearbyRotation(state.rotations[j] * RotationFromAxisAngle(step.segment<3>(at)));
      at += 3;
    }
    state.translation += step.segment<3>(at);
  });
  const FrameLayout& layout = problem_.layout;
  VectorXd all = VectorXd::Zero(layout.num_columns - layout.beta_column);
  for (int i = 0; i < shared_size(); ++i) all[shared_columns_[i] - layout.beta_column] = shared_step[i];
  static_cast<SharedValues&>(*y) = StepShared(layout, x, all);
}

double ChainProblem::SquaredNorm(const ChainPoint& x) const {
  double sum = x.betas.squaredNorm() + x.log_focal * x.log_focal;
  for (const FrameState& state : x.states) {
    sum += state.translation.squaredNorm();
    for (int j : problem_.layout.active_joints) sum += AxisAngleFromRotation(state.rotations[j]).squaredNorm();
  }
  for (size_t v = 0; v < x.views.size(); ++v) {
    const ViewLayout& layout = problem_.layout.views[v];
    const ViewState& view = x.views[v];
    const CameraPose& pose = view.camera_from_scene;
    if (layout.pose_column >= 0) {
      sum += AxisAngleFromRotation(pose.camera_from_world_rotation).squaredNorm() +
             pose.camera_from_world_translation.squaredNorm();
    }
    if (layout.focal_column >= 0) sum += view.log_focal * view.log_focal;
    if (layout.clock_column >= 0) sum += view.offset_s * view.offset_s + view.rate * view.rate;
  }
  return sum;
}

}  // namespace bodyloom
