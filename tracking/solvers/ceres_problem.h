// SPDX-License-Identifier: Apache-2.0
/// A clip's least-squares problem as a ceres::Problem whose parameter and residual blocks have names, so that it can be
/// evaluated, fixed, reweighed, extended and solved with all that Ceres offers.
///
/// Parameter blocks: for each frame the axis-angle of each estimated joint (RotationManifold; derivatives are by right
/// increments) and the translation; for all frames the shape and the logarithm of the focal length, where they are
/// estimated. Residual blocks, by the name of their term:
///   terms of a frame      one block an observation (a 2D joint, a landmark of the lifter, a joint's limits …) with its
///                         own ceres::LossFunction; terms of thousands of observations come compressed, a few blocks a
///                         frame (FrameRows, frame_cost.h)
///   "smoothness"          a joint or the translation in three frames; "velocity" in two
///   "shape prior", "stature", "focal length prior"
///   a user's terms        as they are, whatever number of frames they read
/// All blocks of frames are evaluated together for each new point, on as many threads as wanted, while Ceres itself
/// runs on one (its own threads add gradients up in the order in which they finish): same bytes for any number of
/// threads.
#pragma once

#include <ceres/problem.h>

#include <memory>
#include <string>
#include <vector>

#include "tracking/problem/sequence_problem.h"

namespace bodyloom {

struct CeresProblemOptions {
  int num_threads = 1;
  /// Frames begin ≤ t < end are parameters; of the others those that a term reads beside them, too, but held constant.
  /// end < 0: all frames.
  int begin = 0, end = -1;
  /// All terms of a frame become one block, "terms of the frame", with their kernels inside (CompressedRows(),
  /// frame_cost.h): the same cost, gradient and Gauss–Newton step of a quarter as many blocks. What SolveWithCeres()
  /// asks for; no term can be told from another.
  bool compress_frames = false;
  bool enable_fast_removal = false;  ///< as of ceres::Problem::Options
};

class CeresProblem {
 public:
  /// Parameters start at the states of `problem`, which is borrowed; what its terms point to must outlive this.
  CeresProblem(const SequenceProblem& problem, const CeresProblemOptions& options);
  ~CeresProblem();
  CeresProblem(const CeresProblem&) = delete;
  CeresProblem& operator=(const CeresProblem&) = delete;

  [[nodiscard]] ceres::Problem& problem();

  /// The parameter blocks, for ceres::Problem's calls; null where there is none: the frame is outside, the joint is
  /// held at rest, or the value is not estimated. Rotations and translations have 3 values, the focal length is a
  /// logarithm.
  [[nodiscard]] double* rotation(int t, int joint);
  [[nodiscard]] double* translation(int t);
  [[nodiscard]] double* betas();
  [[nodiscard]] double* log_focal();
  /// "rotation of l_knee, frame 12"; empty for a pointer that is no block of this problem.
  [[nodiscard]] std::string NameOf(const double* block) const;

  struct Block {
    ceres::ResidualBlockId id = nullptr;
    int term = 0;   ///< index into terms()
    int frame = 0;  ///< the first one that it reads; −1: none
  };
  [[nodiscard]] const std::vector<std::string>& terms() const;
  /// Those of the problem as it was built.
  [[nodiscard]] const std::vector<Block>& residual_blocks() const;
  /// ½ Σ ρ of each of terms() at the parameters' values.
  [[nodiscard]] std::vector<double> CostByTerm();
  /// From now on the term counts this many times as much as it did when the problem was built. Throws
  /// std::invalid_argument for a name that is not one of terms(), or a weight that is negative or not finite.
  void SetWeight(const std::string& term, double weight);

  /// Takes the parameters' values back into the problem's states (of the frames begin ≤ t < end), betas and focal
  /// length.
  void CopyTo(SequenceProblem* problem) const;

 private:
  class Builder;
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace bodyloom
