// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/residuals/frame_batch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::VectorXd;
using Mode = FrameAccumulator::Mode;

struct FrameBatch::Frame {
  const FrameLayout* layout;
  const FrameData* data;
  const FrameState* held;
  const SharedValues* held_shared;
  std::vector<double*> parameters;
  std::vector<ResidualGroup> groups;
  std::vector<int> term_of_group;
  std::vector<size_t> first_jacobian;  ///< of each group in `jacobians`, and their end
  std::vector<double> residuals;       ///< row after row
  std::vector<double> jacobians;       ///< group after group, block after block, row-major
  bool compress = false, is_finite = false;

  void Evaluate(Mode mode);
  void Compress(FrameEvaluator* evaluator, const FrameState& state, const SharedValues& shared, Mode mode,
                FrameRows* rows) const;
  void StateOf(FrameState* state, SharedValues* shared) const;
};

void FrameBatch::Frame::StateOf(FrameState* state, SharedValues* shared) const {
  *state = *held;
  *shared = *held_shared;
  size_t block = 0;
  for (int j : layout->active_joints) {
    state->rotations[j] = RotationFromAxisAngle(Eigen::Map<const Eigen::Vector3d>(parameters[block++]));
  }
  state->translation = Eigen::Map<const Eigen::Vector3d>(parameters[block++]);
  if (layout->num_betas > 0) shared->betas = Eigen::Map<const VectorXd>(parameters[block++], layout->num_betas);
  if (layout->focal_column >= 0) shared->log_focal = parameters[block++][0];
  for (size_t v = 0; v < layout->views.size(); ++v) {
    const ViewLayout& view = layout->views[v];
    ViewState& values = shared->views[v];
    if (view.pose_column >= 0) {
      CameraPose& pose = values.camera_from_scene;
      pose.camera_from_world_rotation = RotationFromAxisAngle(Eigen::Map<const Eigen::Vector3d>(parameters[block++]));
      pose.camera_from_world_translation = Eigen::Map<const Eigen::Vector3d>(parameters[block++]);
    }
    if (view.focal_column >= 0) values.log_focal = parameters[block++][0];
    if (view.clock_column >= 0) {
      values.offset_s = parameters[block][0];
      values.rate = parameters[block++][1];
    }
  }
}

void FrameBatch::Frame::Compress(FrameEvaluator* evaluator, const FrameState& state, const SharedValues& shared,
                                 Mode mode, FrameRows* rows) const {
  ResidualGroup group;
  group.num_rows = layout->num_columns + 2;
  for (int block = 0; block < layout->num_blocks(); ++block) group.blocks.push_back(block);
  rows->groups.assign(1, group);
  rows->term_of_group.assign(1, -1);
  if (mode == Mode::kStructure) return;  // the same at every state
  thread_local FrameSystem system;
  const bool derivatives = mode != Mode::kNorms;
  evaluator->Evaluate(*layout, *data, state, shared, derivatives, &system);
  rows->is_finite = std::isfinite(system.cost);
  rows->J.resize(group.num_rows, layout->num_columns);
  rows->r.resize(group.num_rows);
  if (rows->is_finite) CompressedRows(system, derivatives, rows->J, rows->r);
}

void FrameBatch::Frame::Evaluate(Mode mode) {
  thread_local FrameEvaluator evaluator;
  thread_local FrameState state;
  thread_local SharedValues shared;
  thread_local FrameRows rows;
  StateOf(&state, &shared);
  if (compress) {
    Compress(&evaluator, state, shared, mode, &rows);
  } else {
    evaluator.EvaluateRows(*layout, *data, state, shared, mode, &rows);
  }
  is_finite = rows.is_finite;
  if (mode == Mode::kStructure) {
    groups = rows.groups;
    term_of_group = rows.term_of_group;
    size_t next = 0;
    for (const ResidualGroup& group : groups) {
      first_jacobian.push_back(next);
      for (const int block : group.blocks) next += static_cast<size_t>(group.num_rows * layout->NumColumns(block));
    }
    first_jacobian.push_back(next);
    if (!groups.empty()) residuals.resize(static_cast<size_t>(groups.back().first_row + groups.back().num_rows));
    return;
  }
  BODYLOOM_CHECK(rows.groups.size() == groups.size(), "frame batch: ", rows.groups.size(), " groups of residuals, ",
                 groups.size(), " at the point where the problem was built");
  std::copy(rows.r.data(), rows.r.data() + residuals.size(), residuals.begin());
  if (mode == Mode::kNorms) return;
  jacobians.resize(first_jacobian.back());
  double* next = jacobians.data();
  for (const ResidualGroup& group : groups) {
    for (const int block : group.blocks) {
      const int columns = layout->NumColumns(block), first = layout->FirstColumn(block);
      for (int i = 0; i < group.num_rows; ++i) {
        const double* row = &rows.J(group.first_row + i, first);
        next = std::copy(row, row + columns, next);
      }
    }
  }
}

/// Copies a group's residuals and Jacobians out of the batch.
class FrameBatch::CachedCost : public ceres::CostFunction {
 public:
  CachedCost(FrameBatch* batch, const Frame& frame, size_t group) : batch_(batch), frame_(frame), group_(group) {
    const ResidualGroup& g = frame.groups[group];
    for (const int block : g.blocks) mutable_parameter_block_sizes()->push_back(frame.layout->NumColumns(block));
    set_num_residuals(g.num_rows);
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    // Ceres prepares every point except the one at which a problem first evaluates constant blocks.
    if (!batch_->is_prepared_ || (jacobians != nullptr && !batch_->has_jacobians_)) {
      batch_->PrepareForEvaluation(jacobians != nullptr, true);
    }
    if (!frame_.is_finite) return false;
    const double* r = &frame_.residuals[frame_.groups[group_].first_row];
    std::copy(r, r + num_residuals(), residuals);
    if (jacobians == nullptr) return true;
    const double* next = &frame_.jacobians[frame_.first_jacobian[group_]];
    for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
      const size_t size = static_cast<size_t>(num_residuals()) * parameter_block_sizes()[b];
      if (jacobians[b] != nullptr) std::copy(next, next + size, jacobians[b]);
      next += size;
    }
    return true;
  }

 private:
  FrameBatch* batch_;
  const Frame& frame_;
  size_t group_;
};

FrameBatch::FrameBatch(int num_threads, bool compress) : num_threads_(num_threads), compress_(compress) {}

FrameBatch::~FrameBatch() = default;

std::vector<FrameBatch::Entry> FrameBatch::Add(const FrameLayout& layout, const FrameData& data, const FrameState& held,
                                               const SharedValues& held_shared,
                                               const std::vector<double*>& parameters) {
  Frame& frame = *frames_.emplace_back(std::make_unique<Frame>());
  frame.layout = &layout;
  frame.data = &data;
  frame.held = &held;
  frame.held_shared = &held_shared;
  frame.parameters = parameters;
  frame.compress = compress_;
  is_prepared_ = false;
  frame.Evaluate(Mode::kStructure);
  std::vector<Entry> entries;
  for (size_t i = 0; i < frame.groups.size(); ++i) {
    Entry& entry = entries.emplace_back();
    entry.term = frame.term_of_group[i];
    entry.group = frame.groups[i];
    entry.cost = std::make_unique<CachedCost>(this, frame, i);
  }
  return entries;
}

void FrameBatch::PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) {
  if (is_prepared_ && !new_evaluation_point && (has_jacobians_ || !evaluate_jacobians)) return;
  is_prepared_ = true;
  has_jacobians_ = evaluate_jacobians;
  ParallelFor(static_cast<int>(frames_.size()), num_threads_,
              [&](int t) { frames_[t]->Evaluate(evaluate_jacobians ? Mode::kRows : Mode::kNorms); });
}

}  // namespace bodyloom
