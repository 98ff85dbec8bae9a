// SPDX-License-Identifier: Apache-2.0
/// A clip's least-squares problem as a ceres::Problem with named parameter and residual blocks, which can be evaluated,
/// held constant, reweighted, extended and solved with all options of Ceres.
///
/// Parameter blocks: for each frame the axis-angle of each estimated joint (RotationManifold; derivatives are by right
/// increments) and the translation; for all frames the shape and the logarithm of the focal length, and for each other
/// view its pose (axis-angle, translation), logarithm of the focal length and clock (offset, rate), where they are
/// estimated. Residual blocks, by the name of their term:
///   terms of a frame      one block an observation (a 2D joint, a landmark of the lifter, a joint's limits …) with its
///                         own ceres::LossFunction; terms of thousands of observations are compressed to a few blocks a
///                         frame (FrameRows, frame_cost.h)
///   "smoothness"          a joint or the translation in three frames; "velocity" in two
///   "shape prior", "stature", "focal length prior", "focal length as of view 1, view 2", "clock prior, view 2"
///   a user's terms        unchanged, for any number of frames
/// All blocks of frames are evaluated together for each new point, on `num_threads` threads, while Ceres itself runs on
/// one (its own threads sum gradients in the order in which they finish): same bytes for any number of threads.
#pragma once

#include <ceres/problem.h>

#include <memory>
#include <string>
#include <vector>

#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

struct CeresProblemOptions {
  int num_threads = 1;
  /// Frames begin ≤ t < end are variable; other frames that their terms read are constant parameters. end < 0: all
  /// frames.
  int begin = 0, end = -1;
  /// Compresses all terms of a frame into one block, "terms of the frame", which includes their kernels
  /// (CompressedRows(), frame_cost.h): the same cost, gradient and Gauss–Newton step with a quarter as many blocks, but
  /// no costs by term. Used by SolveWithCeres().
  bool compress_frames = false;
  bool enable_fast_removal = false;  ///< as of ceres::Problem::Options
};

class CeresProblem {
 public:
  /// Parameters start at the states of `problem`, which is borrowed; data that its terms point to must outlive this.
  CeresProblem(const SequenceProblem& problem, const CeresProblemOptions& options);
  ~CeresProblem();
  CeresProblem(const CeresProblem&) = delete;
  CeresProblem& operator=(const CeresProblem&) = delete;

  [[nodiscard]] ceres::Problem& problem();

  /// The parameter blocks, for calls of ceres::Problem; null if the frame is outside, the joint is held at rest, or the
  /// value is not estimated. Rotations and translations have 3 values, the focal length is a logarithm.
  [[nodiscard]] double* rotation(int t, int joint);
  [[nodiscard]] double* translation(int t);
  [[nodiscard]] double* betas();
  [[nodiscard]] double* log_focal();
  /// Those of the other views' unknowns: rotation, translation, focal length and clock of the first, and so on.
  [[nodiscard]] std::vector<double*> view_blocks();
  /// "rotation of l_knee, frame 12"; empty for a pointer that is no block of this problem.
  [[nodiscard]] std::string NameOf(const double* block) const;

  struct Block {
    ceres::ResidualBlockId id = nullptr;
    int term = 0;   ///< index into terms()
    int frame = 0;  ///< the first one that it reads; −1: none
  };
  [[nodiscard]] const std::vector<std::string>& terms() const;
  /// The residual blocks of the problem as built.
  [[nodiscard]] const std::vector<Block>& residual_blocks() const;
  /// ½ Σ ρ of each of terms() at the parameters' values.
  [[nodiscard]] std::vector<double> CostByTerm();
  /// Sets the term's weight relative to the problem as built. Throws std::invalid_argument for a name that is not one
  /// of terms(), or a weight that is negative or not finite.
  void SetWeight(const std::string& term, double weight);

  /// Copies the parameters' values to the problem's states (of the frames begin ≤ t < end) and shared values.
  void CopyTo(SequenceProblem* problem) const;

 private:
  class Builder;
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace bodyloom
