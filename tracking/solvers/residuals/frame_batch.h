// SPDX-License-Identifier: Apache-2.0
/// The terms of all frames of a clip as Ceres cost functions that are evaluated together: once for each new point, with
/// the frames distributed over threads; the cost functions then return the cached results.
///
/// A cost function is one group of a frame's residuals (FrameRows, frame_cost.h), before its loss. Its parameter blocks
/// are those that the group depends on, of: the axis-angle of each active joint, the translation, the betas and the
/// logarithm of the focal length (if estimated). Jacobians are by right increments and must be used with
/// RotationManifold, whose PlusJacobian is the identity.
#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>

#include <memory>
#include <vector>

#include "tracking/problem/frame_cost.h"

namespace bodyloom {

class FrameBatch : public ceres::EvaluationCallback {
 public:
  /// `compress`: all terms of a frame as one group of CompressedRows().
  FrameBatch(int num_threads, bool compress);
  ~FrameBatch() override;
  FrameBatch(const FrameBatch&) = delete;
  FrameBatch& operator=(const FrameBatch&) = delete;

  struct Entry {
    int term = 0;         ///< index into the frame's list; −1: all of it
    ResidualGroup group;  ///< `blocks` are indices into what Add() was given as parameters
    std::unique_ptr<ceres::CostFunction> cost;
  };
  /// Adds a frame, with the parameter blocks of all its unknowns in the layout's order; `held` and `held_shared` give
  /// the values that are not unknown. All are borrowed; the cost functions must not outlive the batch.
  std::vector<Entry> Add(const FrameLayout& layout, const FrameData& data, const FrameState& held,
                         const SharedValues& held_shared, const std::vector<double*>& parameters);
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

 private:
  struct Frame;
  class CachedCost;
  std::vector<std::unique_ptr<Frame>> frames_;
  int num_threads_;
  bool compress_;
  bool is_prepared_ = false, has_jacobians_ = false;
};

}  // namespace bodyloom
