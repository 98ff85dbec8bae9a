// SPDX-License-Identifier: Apache-2.0
/// The linear algebra of the chain solver: a symmetric positive definite matrix of T frames of n values each, coupled
/// to their two neighbours on each side, and s values shared by all frames (an arrow),
///
///       ⎡ A₀   C₀   D₀             B₀ ⎤
///       ⎢ C₀ᵀ  A₁   C₁   D₁        B₁ ⎥      A_t  n×n
///   M = ⎢ D₀ᵀ  C₁ᵀ  A₂   C₂   …    B₂ ⎥      C_t, D_t  n×n, block diagonal in blocks of 3×3
///       ⎢           …              …  ⎥      B_t  n×s
///       ⎣ B₀ᵀ  B₁ᵀ  B₂ᵀ  …         S  ⎦      S  s×s
///
/// solved exactly by block elimination, frame after frame, shared values last. A frame's elimination costs 4.2 n³
/// multiplications and additions: C fills up, D does not (U⁻ᵀD stays lower triangular), so a third of a plain band
/// factorisation's work is left out. Cuts divide the chain into independent segments. A segment is eliminated from both
/// ends at once and its two middle frames last, which costs nothing extra and makes two tasks that share no data: two
/// threads work, and the sums are taken in the same order however many threads there are.
///
/// Memory: 8 n (2n + s + 4) bytes a frame. Source of the elimination: any text on block band Cholesky; from both ends:
/// "burn at both ends" (twisted) factorisation, van der Vorst 1987.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace bodyloom {

/// Hands out the matrix and the right-hand side, frame by frame; called from several threads.
class ChainSource {
 public:
  virtual ~ChainSource() = default;
  /// Adds frame t's upper triangle of A_t to a, (B_t | right-hand side) to b; row-major with strides.
  virtual void AddFrame(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const = 0;
  /// n/3 row-major 3×3 blocks of C_t (frame t with t + 1) and D_t (t with t + 2); not asked for across cuts.
  [[nodiscard]] virtual const double* Next(int t) const = 0;
  [[nodiscard]] virtual const double* Second(int t) const = 0;
  /// n×n row-major block that is added to C_t where a coupling is not block diagonal, or null. Only the first frame of
  /// a segment may have one (what a marginal prior couples, chain_prior.h).
  [[nodiscard]] virtual const double* DenseNext(int /*t*/) const { return nullptr; }
};

class ChainFactor {
 public:
  /// `frame_size` n is a multiple of 3; `cut_before[t]` separates frame t from t − 1.
  ChainFactor(int frame_size, int shared_size, std::vector<char> cut_before);

  /// Solves M x = b. `shared` is S (lower triangle read), `shared_rhs` its right-hand side; the answer lies in
  /// `frames` (T·n) and `shared_step`. False, with the answer undefined, when M is not positive definite to rounding.
  bool Solve(const ChainSource& source, const Eigen::MatrixXd& shared, const Eigen::VectorXd& shared_rhs,
             int num_threads, Eigen::VectorXd* frames, Eigen::VectorXd* shared_step);

  [[nodiscard]] int num_frames() const { return static_cast<int>(cut_before_.size()); }
  /// Another number of frames or other cuts; memory is kept.
  void SetCuts(std::vector<char> cut_before);

 private:
  struct Panel;
  struct Half;
  struct Segment;
  bool Eliminate(const ChainSource& source, Half* half);
  bool EliminateMiddle(const ChainSource& source, Half* forward, Half* backward, Segment* segment);
  bool Step(int t, Panel* front, Panel* next, Panel* second, std::vector<double>* shared_sum);
  void BackSubstitute(int t, int next, int second, const double* shared, double* frames) const;
  void Store(int t, const Panel& front);

  int n_, s_;
  int b_columns_;  ///< of the arrow section of a panel: s + 1 rounded up
  std::vector<char> cut_before_;
  std::vector<std::vector<double>> factor_;  ///< T: rows of [U from the diagonal | W₁ | arrow and right-hand side | W₂]
};

}  // namespace bodyloom
