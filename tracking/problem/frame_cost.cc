// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/frame_cost.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "tracking/problem/moving_camera.h"

namespace bodyloom {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Mode = FrameAccumulator::Mode;

namespace {

/// Blocks that a group of a frame whose camera moves depends on: a translation there is the scene's and the shape's
/// (moving_camera.h).
void AddShapeOfTranslation(const FrameLayout& layout, std::vector<int>* blocks) {
  if (layout.BetaBlock() < 0 || !std::binary_search(blocks->begin(), blocks->end(), layout.TranslationBlock())) return;
  const auto at = std::lower_bound(blocks->begin(), blocks->end(), layout.BetaBlock());
  if (at == blocks->end() || *at != layout.BetaBlock()) blocks->insert(at, layout.BetaBlock());
}

/// The group of a compressed system, which depends on everything.
ResidualGroup AllBlocks(const FrameLayout& layout) {
  ResidualGroup group;
  group.num_rows = layout.num_columns + 2;
  for (int block = 0; block < layout.num_blocks(); ++block) group.blocks.push_back(block);
  return group;
}

int NumRows(const TermList& terms) {
  int rows = 0;
  for (const auto& term : terms) rows += term->num_rows();
  return rows;
}

int NextRow(const FrameRows& rows) {
  return rows.groups.empty() ? 0 : rows.groups.back().first_row + rows.groups.back().num_rows;
}

}  // namespace

std::string NameOfTerm(const FrameTerm& term, int view) {
  return view < 0 ? term.name() : term.name() + ", view " + std::to_string(view + 2);
}

void FrameEvaluator::Begin(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                           const SharedValues& shared, Mode mode, FrameResiduals* residuals) {
  const bool moves = data.camera_from_scene != nullptr;
  if (moves) in_camera_ = StateInCamera(layout, *data.camera_from_scene, shared.betas, state);
  sums_.Begin(layout, moves ? in_camera_ : state, shared.betas, shared.log_focal, mode, residuals);
}

ViewColumns FrameEvaluator::BeginView(const FrameLayout& layout, const ViewTerms& view, const FrameState& state,
                                      const SharedValues& shared, Mode mode, FrameResiduals* residuals) {
  const ViewLayout& of = layout.views[view.view];
  const ViewState& pose = shared.views[view.view];
  in_view_ = StateInCamera(*of.local, CameraOfView(view, pose), shared.betas, state);
  view_sums_.max_points = sums_.max_points;
  view_sums_.Begin(*of.local, in_view_, shared.betas, pose.log_focal, mode, residuals);
  view_sums_.SetClockShift(pose.offset_s + pose.rate * view.clock_s - view.sampled_s);
  return {layout, view, pose, state, shared.betas};
}

void FrameEvaluator::Evaluate(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                              const SharedValues& shared, bool derivatives, FrameSystem* system,
                              FrameResiduals* residuals, std::vector<double>* term_costs) {
  const Mode mode = derivatives ? Mode::kSums : Mode::kCost;
  const auto add = [&](const TermList& terms, FrameAccumulator* sums) {
    if (derivatives) sums->ReserveRows(NumRows(terms));
    for (const auto& term : terms) {
      const double before = sums->cost();
      term->Add(sums);
      if (term_costs != nullptr) term_costs->push_back(sums->cost() - before);
    }
  };
  if (term_costs != nullptr) term_costs->clear();
  Begin(layout, data, state, shared, mode, residuals);
  add(data.terms, &sums_);
  sums_.Finish(system);
  if (data.camera_from_scene != nullptr && derivatives) TakeToScene(layout, *data.camera_from_scene, system);
  for (const ViewTerms& view : data.views) {
    const ViewColumns columns = BeginView(layout, view, state, shared, mode, residuals);
    add(view.terms, &view_sums_);
    view_sums_.Finish(&view_system_);
    system->cost += view_system_.cost;
    system->num_invalid += view_system_.num_invalid;
    if (derivatives) columns.AddSums(view_system_, system);
  }
}

void FrameEvaluator::EvaluateRows(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                                  const SharedValues& shared, Mode mode, FrameRows* rows) {
  const bool derivatives = mode != Mode::kNorms;
  Begin(layout, data, state, shared, mode, nullptr);
  rows->groups.clear();
  rows->term_of_group.clear();
  rows->is_finite = true;
  int num_rows = 0;
  data.ForEachTerm([&](const FrameTerm* term, int /*view*/) {
    if (!term->is_empty()) num_rows += term->is_compressed() ? layout.num_columns + 2 : term->num_rows();
  });
  if (rows->J.cols() != layout.num_columns || rows->J.rows() < num_rows) {
    rows->J.resize(num_rows, layout.num_columns);
    rows->r.resize(num_rows);
  }
  int index = 0;
  for (const auto& term : data.terms) {
    if (term->is_empty()) {
      ++index;
      continue;
    }
    if (term->is_compressed()) {
      sums_.SetMode(derivatives ? Mode::kSums : Mode::kCost);
      sums_.ReserveRows(term->num_rows());
      term->Add(&sums_);
      AppendCompressed(index, layout, data, derivatives, rows);
    } else {
      sums_.SetMode(mode);
      sums_.ReserveRows(term->num_rows());
      term->Add(&sums_);
      AppendGroups(index, layout, data, rows);
    }
    rows->is_finite = rows->is_finite && std::isfinite(sums_.cost());
    ++index;
  }
  for (const ViewTerms& view : data.views) {
    const ViewColumns columns = BeginView(layout, view, state, shared, mode, nullptr);
    AppendRowsOfView(index, view, columns, mode, rows);
    index += static_cast<int>(view.terms.size());
  }
}

void FrameEvaluator::AppendRowsOfView(int first_term, const ViewTerms& view, const ViewColumns& columns, Mode mode,
                                      FrameRows* rows) {
  const bool derivatives = mode != Mode::kNorms;
  const FrameLayout& local = view_sums_.layout();
  int index = first_term - 1;
  for (const auto& term : view.terms) {
    ++index;
    if (term->is_empty()) continue;
    const int first = NextRow(*rows);
    view_sums_.SetMode(!term->is_compressed() ? mode : derivatives ? Mode::kSums : Mode::kCost);
    view_sums_.ReserveRows(term->num_rows());
    term->Add(&view_sums_);
    rows->is_finite = rows->is_finite && std::isfinite(view_sums_.cost());
    std::vector<ResidualGroup> groups = view_sums_.groups();
    RowMatrixXd J;
    if (term->is_compressed()) {
      view_sums_.Finish(&view_system_);
      groups.assign(1, AllBlocks(local));
      J.resize(groups[0].num_rows, local.num_columns);
      CompressedRows(view_system_, derivatives, J, rows->r.segment(first, J.rows()));
    } else {
      const int count = view_sums_.num_rows();
      rows->r.segment(first, count) = view_sums_.residual_values().head(count);
      if (derivatives) J = view_sums_.rows().topLeftCorner(count, local.num_columns);
    }
    if (derivatives) columns.TakeRows(J, rows->J.middleRows(first, J.rows()));
    for (ResidualGroup& group : groups) {
      group.first_row += first;
      group.blocks = columns.Blocks(group.blocks);
      rows->groups.push_back(std::move(group));
      rows->term_of_group.push_back(index);
    }
  }
}

void FrameEvaluator::AppendGroups(int term, const FrameLayout& layout, const FrameData& data, FrameRows* rows) {
  const int first = NextRow(*rows), count = sums_.num_rows();
  rows->r.segment(first, count) = sums_.residual_values().head(count);
  if (sums_.derivatives()) {
    auto J = rows->J.middleRows(first, count);
    J = sums_.rows().topLeftCorner(count, layout.num_columns);
    if (data.camera_from_scene != nullptr) TakeRowsToScene(layout, *data.camera_from_scene, J);
  }
  for (const ResidualGroup& group : sums_.groups()) {
    ResidualGroup& added = rows->groups.emplace_back(group);
    added.first_row += first;
    rows->term_of_group.push_back(term);
    if (data.camera_from_scene != nullptr) AddShapeOfTranslation(layout, &added.blocks);
  }
}

void FrameEvaluator::AppendCompressed(int term, const FrameLayout& layout, const FrameData& data, bool derivatives,
                                      FrameRows* rows) {
  sums_.Finish(&system_);
  if (data.camera_from_scene != nullptr && derivatives) TakeToScene(layout, *data.camera_from_scene, &system_);
  ResidualGroup group = AllBlocks(layout);
  group.first_row = NextRow(*rows);
  CompressedRows(system_, derivatives, rows->J.middleRows(group.first_row, group.num_rows),
                 rows->r.segment(group.first_row, group.num_rows));
  rows->groups.push_back(std::move(group));
  rows->term_of_group.push_back(term);
}

void CompressedRows(const FrameSystem& system, bool derivatives, Eigen::Ref<RowMatrixXd> J, Eigen::Ref<VectorXd> r) {
  if (!derivatives) {
    r.setZero();
    r[r.size() - 1] = std::sqrt(2 * system.cost);
    return;
  }
  thread_local MatrixXd R;
  thread_local VectorXd y;
  const Eigen::Index p = system.H.rows();
  SquareRootSystem(system.H, system.gradient, &R, &y);
  J.topRows(p) = R;
  J.bottomRows(2).setZero();
  r.head(p) = y;
  r.tail(2).setZero();
  double rest = std::max(0.0, 2 * system.cost - y.squaredNorm());
  // Directions whose pivots are zero to rounding: their gradient is a row's with as little curvature as leaves it room.
  const bool is_definite = R.diagonal().minCoeff() > 0;
  const VectorXd left_out =
      is_definite ? VectorXd() : VectorXd(system.gradient - R.triangularView<Eigen::Upper>().transpose() * y);
  const double size = left_out.norm();
  if (size > 1e-12 * system.gradient.norm() && rest > 0) {
    const double scale = size * std::sqrt(2 / rest);
    J.row(p) = scale / size * left_out.transpose();
    r[p] = size / scale;
    rest = std::max(0.0, rest - r[p] * r[p]);
  }
  r[p + 1] = std::sqrt(rest);
}

void SquareRootSystem(const MatrixXd& H, const VectorXd& g, MatrixXd* R, VectorXd* y) {
  const Eigen::Index n = H.rows();
  const double tolerance = 1e-14 * H.diagonal().cwiseAbs().maxCoeff();
  const Eigen::LLT<MatrixXd, Eigen::Lower> factor(H);
  if (factor.info() == Eigen::Success && factor.matrixLLT().diagonal().minCoeff() > std::sqrt(tolerance)) {
    *R = factor.matrixU();
    *y = factor.matrixL().solve(g);
    return;
  }
  // Semi-definite: left-looking Cholesky that leaves a zero row for every parameter nothing depends on.
  R->setZero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double pivot = H(i, i) - R->col(i).head(i).squaredNorm();
    if (!(pivot > tolerance)) continue;
    const double root = std::sqrt(pivot);
    (*R)(i, i) = root;
    for (Eigen::Index j = i + 1; j < n; ++j) {
      (*R)(i, j) = (H(j, i) - R->col(i).head(i).dot(R->col(j).head(i))) / root;
    }
  }
  y->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double root = (*R)(i, i);
    (*y)[i] = root > 0 ? (g[i] - R->col(i).head(i).dot(y->head(i))) / root : 0.0;
  }
}

}  // namespace bodyloom
