// SPDX-License-Identifier: Apache-2.0
/// Linear solver of the chain engine, for a symmetric positive definite matrix of T frames of n values each, coupled to
/// their two neighbours on each side, and s values shared by all frames (an arrow),
///
///       ⎡ A₀   C₀   D₀             B₀ ⎤
///       ⎢ C₀ᵀ  A₁   C₁   D₁        B₁ ⎥      A_t  n×n
///   M = ⎢ D₀ᵀ  C₁ᵀ  A₂   C₂   …    B₂ ⎥      C_t, D_t  n×n, block diagonal in blocks of 3×3
///       ⎢           …              …  ⎥      B_t  n×s
///       ⎣ B₀ᵀ  B₁ᵀ  B₂ᵀ  …         S  ⎦      S  s×s
///
/// (or C_t any matrix, ChainSource::DenseNext)
/// solved exactly by block elimination, frame after frame, shared values last. A frame's elimination costs 4.2 n³
/// multiplications and additions: C fills up, D does not (U⁻ᵀD stays lower triangular), which saves a third of the work
/// of a plain band factorisation. Cuts divide the chain into independent segments. A segment is eliminated from both
/// ends at once and its two middle frames last, at no extra cost: two tasks that share no data run in two threads, and
/// the order of summation is the same for any number of threads.
///
/// Memory: 8 n (2n + s + 4) bytes a frame for up to kMaxKept frames. Of longer chains every kBlock-th frame's state of
/// the elimination is kept instead, a twentieth of that, and the rows of the frames between are computed a second time
/// when they are needed: the same bits, for the time of a second elimination of these frames. Beside it scratch memory
/// that is kept from one solve to the next: allocating it for each of many solves of a few frames would take as long as
/// the elimination. Source of the elimination: any text on block band Cholesky; from both ends: "burn at both ends"
/// (twisted) factorisation, van der Vorst 1987; of the second elimination: checkpoints as in Griewank 1992.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace bodyloom {

/// Interface that provides the matrix and the right-hand side, frame by frame; called from several threads.
class ChainSource {
 public:
  virtual ~ChainSource() = default;
  /// Adds frame t's upper triangle of A_t to a, (B_t | right-hand side) to b; row-major with strides.
  virtual void AddFrame(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const = 0;
  /// n/3 row-major 3×3 blocks of C_t (frame t with t + 1) and D_t (t with t + 2); not requested across cuts.
  [[nodiscard]] virtual const double* Next(int t) const = 0;
  [[nodiscard]] virtual const double* Second(int t) const = 0;
  /// n×n row-major block that is added to C_t where a coupling is not block diagonal, or null: from a marginal prior
  /// (chain_problem.h), or from a cost function on two frames' landmarks. Not requested across cuts.
  [[nodiscard]] virtual const double* DenseNext(int /*t*/) const { return nullptr; }
};

class ChainFactor {
 public:
  /// `frame_size` n is a multiple of 3; `cut_before[t]` separates frame t from t − 1. The last `num_multipliers` of the
  /// shared values are multipliers (chain_couplings.cc): M is then not positive definite in them.
  /// `max_kept`: number of frames whose rows are kept, at least.
  ChainFactor(int frame_size, int shared_size, std::vector<char> cut_before, int num_multipliers = 0,
              int max_kept = kMaxKept);
  static constexpr int kMaxKept = 1024, kBlock = 128;
  ~ChainFactor();
  ChainFactor(const ChainFactor&) = delete;
  ChainFactor& operator=(const ChainFactor&) = delete;

  /// Solves M x = b. `shared` is S (lower triangle read), `shared_rhs` its right-hand side; the solution is written to
  /// `frames` (T·n) and `shared_step`. Returns false, with the solution undefined, when M is not positive definite to
  /// rounding.
  bool Solve(const ChainSource& source, const Eigen::MatrixXd& shared, const Eigen::VectorXd& shared_rhs,
             int num_threads, Eigen::VectorXd* frames, Eigen::VectorXd* shared_step);

  /// Sets the frozen frames (T flags; empty: none). While there are any, they and the shared values have a step of
  /// zero: Solve() solves the system of the other frames only.
  void SetFrozen(std::vector<char> frozen);

  /// Computes blocks of M⁻¹ for the matrix of the last Solve(), which must have succeeded and had no frozen frames, and
  /// whose source is asked for it again where there are more than max_kept frames:
  /// calls visit(t, P) for each frame begin ≤ t < end with the (n + s)² block of its values and, after them, of the
  /// shared ones, in no particular order and from up to num_threads threads.
  ///
  /// With rows [U | W₁ | W₂ | Y] of the factor, V = U⁻ᵀ, K_i = U⁻¹W_i, and C = the inverse given the shared values:
  ///   C_tu = −K₁ C_1u − K₂ C_2u (u = the next two frames),   C_tt = VᵀV − K₁ C_1t − K₂ C_2t,
  ///   G_t = −U⁻¹Y − K₁ G_1 − K₂ G_2,   P_tt = C_tt + G_t P_ss G_tᵀ,   P_ts = G_t P_ss
  /// from the middle of a segment, where the elimination ended, outwards as far as requested: 7 n³ multiplications and
  /// additions a frame, constant memory. Source: Takahashi, Fagan, Chen 1973 (selected inverse).
  /// `shared_inverse`: P_ss in place of this matrix's; null: this matrix's.
  void VisitInverse(int begin, int end, int num_threads, const std::function<void(int, const Eigen::MatrixXd&)>& visit,
                    const Eigen::MatrixXd* shared_inverse = nullptr) const;

  [[nodiscard]] int num_frames() const { return static_cast<int>(cut_before_.size()); }
  /// Sets another number of frames or other cuts; memory is kept.
  void SetCuts(std::vector<char> cut_before);

 private:
  struct Panel;
  struct Half;
  class Inverse;
  class InversePool;
  /// Frames between two cuts, or frozen frames; `middle` is the first of the (up to) two that are eliminated last.
  struct Segment {
    int begin = 0, end = 0, middle = 0;
  };
  [[nodiscard]] std::vector<Segment> Segments() const;
  static std::shared_ptr<InversePool> MakeInversePool();
  [[nodiscard]] std::vector<Half> HalvesOf(const std::vector<Segment>& segments) const;
  /// Chooses the frames whose rows are kept: those next to the middles, which are needed first.
  void PlanMemory();
  void AddToFront(const ChainSource& source, int t, int direction, Panel* front) const;
  bool Eliminate(const ChainSource& source, Half* half);
  bool EliminateMiddle(const ChainSource& source, const Segment& segment, Half* forward, Half* backward,
                       std::vector<double>* shared_sum);
  /// Eliminates the frame of `front`, whose rows are written to `rows` unless it is null.
  bool Step(Panel* front, Panel* next, Panel* second, std::vector<double>* shared_sum, std::vector<double>* rows) const;
  /// Calls visit(t, rows) for the frames of half `h` of the last Solve(), from the last one eliminated to the first,
  /// until it returns false.
  void VisitRows(int h, const std::function<bool(int, const std::vector<double>&)>& visit) const;
  void BackSubstitute(int t, const std::vector<double>& rows, int next, int second, const double* shared,
                      double* frames) const;
  void Store(const Panel& front, std::vector<double>* rows) const;

  int n_, s_, num_multipliers_, max_kept_;
  int b_columns_;  ///< of the arrow section of a panel: s + 1 rounded up
  std::vector<char> cut_before_;
  std::vector<char> frozen_;                 ///< T, or empty: none
  std::vector<std::vector<double>> factor_;  ///< T: rows of [U from the diagonal | W₁ | arrow and right-hand side | W₂]
  std::vector<Half> halves_;                 ///< two a segment, of the last Solve()
  const ChainSource* source_ = nullptr;      ///< of the last Solve()
  Eigen::MatrixXd shared_inverse_;           ///< s×s block of M⁻¹
  std::vector<std::vector<Panel>> panels_;  ///< scratch of the halves that are eliminated at the same time
  std::vector<Panel> middle_panels_;
  std::shared_ptr<InversePool> inverses_ = MakeInversePool();
};

}  // namespace bodyloom
