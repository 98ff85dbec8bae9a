// SPDX-License-Identifier: Apache-2.0
/// Evaluates a SequenceProblem for the chain solver: cost, gradient and Gauss–Newton matrix at a point, in the blocks
/// of chain_factor.h. Frames come from FrameEvaluator, smoothness from the formulas of residuals/acceleration_cost.h,
/// shared priors as in sequence_problem.h, users' cost functions on several frames from problem/user_cost.h; without
/// approximation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "tracking/problem/frame_cost.h"
#include "tracking/problem/frame_layout.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/solvers/chain/chain_factor.h"
#include "tracking/solvers/residuals/acceleration_cost.h"

namespace bodyloom {

/// The marginal prior of removed frames on the first two frames of the chain, and on shape and focal length:
///   ½ eᵀ M e + mᵀ e,   e = x ⊟ x̄ = (log(R̄ᵀR) of each active joint, t − t̄ of both frames; β − β̄; log f − log f̄)
/// M and m are the Schur complement of the removed frames in the normal equations. It is exact for linear measurements;
/// others keep their last linearisation.
struct ChainPrior {
  bool set = false;
  std::array<FrameState, 2> states;  ///< x̄ of the first two frames
  Eigen::VectorXd betas;             ///< β̄
  double log_focal = 0;
  Eigen::MatrixXd M;  ///< (2n + s)², symmetric: first frame, second frame, shared values that are unknown
  Eigen::VectorXd m;
};

/// Number of residuals of couplings between frames that are not neighbours (chain_couplings.cc); a ChainProblem
/// supports at most ChainProblem::kMaxFarRows.
int NumFarRows(const SequenceProblem& problem);

/// Values of the unknowns.
struct ChainPoint : SharedValues {
  std::vector<FrameState> states;
  ChainPoint() = default;
  ChainPoint(std::vector<FrameState> frames, SharedValues shared)
      : SharedValues(std::move(shared)), states(std::move(frames)) {}
};

class ChainProblem : public ChainSource {
 public:
  /// The problem is borrowed. Its states, betas and log_focal are not read.
  ChainProblem(const SequenceProblem& problem, bool shape_constant, bool focal_constant, int num_threads);
  ~ChainProblem() override;

  /// Limits the observations used of a term with thousands in a frame (FrameEvaluator::LimitPoints); 0: all.
  void LimitPoints(int max_points);
  /// Sets the share below which linearisations are reused: a frame is not evaluated if, since its last linearisation,
  /// its residuals have changed by less than this share of their size (root mean square: ½ dᵀHd ≤ share² c), and no
  /// unknown by more than 0.05 (radians, metres, log focal length, 0.03 betas). Then its cost is c + gᵀd + ½ dᵀHd and
  /// its gradient g + Hd, with errors of O(d³) and O(d²) times the residuals' curvature. 0: all frames are evaluated.
  void ReuseLinearisation(double share) {
    if (share != reuse_share_) linearised_ = false;
    reuse_share_ = share;
  }
  /// Sets the frozen frames (T flags; empty: none). Until the next call they and the shared values keep their values of
  /// the last Linearise(), so only the other frames and their neighbours are evaluated. Exact; shared() and
  /// shared_gradient() are not updated meanwhile. Throws std::invalid_argument unless the last call was Linearise(),
  /// and with a prior.
  void SetFrozen(std::vector<char> frozen);
  /// Number of frames for which the last Cost() or Linearise() reused an earlier linearisation.
  [[nodiscard]] int num_skipped() const { return num_skipped_; }
  /// Sets a prior in addition to the problem's terms; borrowed, null: none. The problem must have two frames or more,
  /// and neither couplings nor several views.
  void SetPrior(const ChainPrior* prior);

  /// To be called after the borrowed problem has lost its first `dropped` frames; it may also have new frames at its
  /// end, other cuts or other shared priors.
  void Moved(int dropped);
  /// To be called after a change of frame t's observations.
  void Forget(int t) {
    anchors_[t].set = false;
    linearised_ = false;
  }
  /// Marginalises frame 0 and the current prior to a prior on frames 1 and 2 and the shared values, at the point
  /// linearised last, `point`. Returns false when frame 0's matrix is singular.
  bool Marginalise(const ChainPoint& point, ChainPrior* prior) const;

  /// Evaluates only the cost; NaN if a frame's is not finite.
  double Cost(const ChainPoint& point);
  /// Evaluates the cost, and everything that the factorisation needs. Returns at once at the point of the last call,
  /// unless Cost() was called or something was changed since.
  double Linearise(const ChainPoint& point);

  // At the point linearised last.
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }                ///< T·n
  [[nodiscard]] const Eigen::VectorXd& shared_gradient() const { return shared_gradient_; }  ///< s
  [[nodiscard]] const Eigen::VectorXd& diagonal() const { return diagonal_; }                ///< of the matrix, T·n
  [[nodiscard]] const Eigen::MatrixXd& shared() const { return shared_; }                    ///< s×s, undamped
  [[nodiscard]] Eigen::VectorXd shared_diagonal() const { return shared_.diagonal() + far_shared_diagonal_; }
  /// The shared block for ChainFactor: S with its damping, followed by the multipliers of far couplings.
  [[nodiscard]] Eigen::MatrixXd Arrow(const Eigen::VectorXd& damping) const;

  /// Damping that AddFrame adds to the diagonal (T·n values).
  void SetDamping(const Eigen::VectorXd* damping) { damping_ = damping; }

  /// x ⊞ step: rotations by right increments.
  void Plus(const ChainPoint& x, const Eigen::VectorXd& step, const Eigen::VectorXd& shared_step, ChainPoint* y) const;
  /// ‖x‖² of the unknowns with rotations as axis-angle.
  [[nodiscard]] double SquaredNorm(const ChainPoint& x) const;

  [[nodiscard]] int frame_size() const { return n_; }
  [[nodiscard]] int shared_size() const { return static_cast<int>(shared_columns_.size()); }
  /// Including the multipliers of couplings between frames that are not neighbours (chain_couplings.cc).
  [[nodiscard]] int arrow_size() const { return shared_size() + num_far_rows_; }
  [[nodiscard]] int num_far_rows() const { return num_far_rows_; }
  static constexpr int kMaxFarRows = 400;
  [[nodiscard]] const std::vector<char>& cut_before() const { return problem_.cut_before; }

  void AddFrame(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const override;
  [[nodiscard]] const double* Next(int t) const override { return &next_[static_cast<size_t>(t) * 3 * n_]; }
  [[nodiscard]] const double* Second(int t) const override { return &second_[static_cast<size_t>(t) * 3 * n_]; }
  [[nodiscard]] const double* DenseNext(int t) const override {
    if (prior_ != nullptr) return t == 0 ? prior_next_.data() : nullptr;
    return !pair_next_.empty() && pair_next_[t].size() > 0 ? pair_next_[t].data() : nullptr;
  }

 private:
  [[nodiscard]] bool IsLinearisedAt(const ChainPoint& point) const;
  /// The change from frame t − 1 to t: log(R₋ᵀR) of each active joint, then the translation's difference.
  struct Change {
    std::vector<Eigen::Vector3d> step;
    std::vector<Eigen::Matrix3d> right;  ///< RightJacobianInverse of the rotations' steps
  };
  /// The point at which a frame's system was evaluated.
  struct Anchor {
    bool set = false;
    FrameState state;
    SharedValues shared;
    double cost = 0;
  };
  /// A frame's system at its anchor, half as large as a FrameSystem: the lower triangle of H by columns.
  struct PackedSystem {
    Eigen::Index size = 0;
    std::vector<double> triangle;
    Eigen::VectorXd gradient;  ///< where linearisations are reused

    void Pack(const FrameSystem& system, bool with_gradient);
    void UnpackTo(Eigen::MatrixXd* H) const;  ///< its lower triangle
    /// Column i of H, whose entries from row i on are there.
    [[nodiscard]] const double* Column(Eigen::Index i) const { return &triangle[i * size - i * (i + 1) / 2]; }
    [[nodiscard]] double H(Eigen::Index row, Eigen::Index column) const { return Column(column)[row]; }
  };
  /// A cost function on several frames, weighted by its loss.
  struct Coupling {
    const FrameCoupling* source = nullptr;
    double cost = 0;
    UserResidual at;
    int first_far_row = -1;  ///< of its multipliers; −1: of two frames in a row, which have none
  };
  /// A coupling and the index of a frame among those that it reads.
  struct CouplingOfFrame {
    int index, k;
  };
  struct Scratch;
  class Lease;
  void Resize();
  /// Steps from a frame's anchor: n values, then the shared ones that are unknown. False when one is too long.
  bool StepsFrom(const Anchor& anchor, const FrameState& state, const ChainPoint& point, Eigen::VectorXd* d) const;
  double EvaluatePrior(const ChainPoint& point, bool derivatives);
  void AddPrior();
  double EvaluateFrames(const ChainPoint& point, bool derivatives);
  [[nodiscard]] bool IsFrozen(size_t t) const { return !frozen_.empty() && frozen_[t] != 0; }
  /// True if frames first … last are frozen, so that costs of these frames have not changed.
  [[nodiscard]] bool AllFrozen(int64_t first, int64_t last) const;
  double EvaluateChanges(const ChainPoint& point, bool derivatives);
  void ResizeCouplings();
  double EvaluateCouplings(const ChainPoint& point, bool derivatives);
  void EvaluateCoupling(const ChainPoint& point, bool derivatives, Coupling* coupling) const;
  /// Adds the couplings' part of frame t's rows: AddFrame() without gradient and damping.
  void AddCouplings(int t, double* a, int64_t a_stride, double* b, int64_t b_stride) const;
  /// Adds the couplings' part of frame t's gradient and diagonal.
  void AssembleCouplings(int t);
  void SumSharedOfCouplings();
  /// Column of a coupling's Jacobian for one of shared_columns_.
  [[nodiscard]] int SharedColumnOf(const Coupling& coupling, int shared) const;
  void SumShared(const ChainPoint& point);
  double SharedCost(const ChainPoint& point) const;
  void AddSharedPriors(const ChainPoint& point);
  /// Index of a layout's column among the shared unknowns that are estimated; −1: not one of them.
  [[nodiscard]] std::ptrdiff_t SharedIndexOf(int column) const;
  [[nodiscard]] bool HasAcceleration(size_t t) const;
  [[nodiscard]] bool HasVelocity(size_t t) const;
  /// Of joint (or translation) a in frames end − 2, end − 1, end: Jacobians of σ r, 1/σ², and r/σ.
  [[nodiscard]] const std::vector<Eigen::Array3d>& InverseSigma(size_t t) const {
    return inverse_sigma_[inverse_sigma_.size() > 1 ? shot_[t] : 0];
  }
  void AccelerationOf(size_t end, int a, Eigen::Matrix3d J[3], Eigen::Array3d* weight, Eigen::Vector3d* force) const;
  /// Computes frame t's blocks of matrix and gradient from the accelerations that end at frames t, t + 1 and t + 2.
  void AssembleAcceleration(size_t t);
  /// Adds those of the velocities that end at frames t and t + 1.
  void AssembleVelocity(size_t t);

  const SequenceProblem& problem_;
  int n_, blocks_, num_threads_, max_points_ = 0, num_skipped_ = 0;
  double reuse_share_ = 0;
  bool linearised_ = false;  ///< true if the results of Linearise() are valid, for the point below
  ChainPoint linearised_at_;
  double linearised_cost_ = 0;
  std::vector<int> shared_columns_;  ///< columns of a frame's matrix that are unknown and shared, ascending
  bool shape_constant_, focal_constant_;
  RowMatrixXd shape_prior_;  ///< residual = shape_prior_ β + shape_offset_
  Eigen::VectorXd shape_offset_;
  std::vector<PackedSystem> systems_;                       ///< T, at their anchors
  std::vector<Anchor> anchors_;                             ///< T
  std::vector<char> skipped_;                               ///< T: the last evaluation reused the anchor's
  std::vector<Eigen::VectorXd> frame_gradient_;             ///< T, at the point linearised last
  std::vector<Change> changes_;                             ///< T
  std::vector<AccelerationFactors> factors_;                ///< T, of the acceleration that ends at each frame
  std::vector<std::vector<Eigen::Array3d>> inverse_sigma_;  ///< n/3 of each entry of SequenceProblem::smoothness
  std::vector<Eigen::Array3d> inverse_velocity_sigma_;      ///< n/3, or empty: no velocities
  std::vector<int> shot_;                                   ///< T, where the shots differ in smoothness
  std::vector<char> frozen_;                                ///< T, or empty: none
  std::vector<double> costs_, acceleration_costs_;          ///< T; of the acceleration that ends at each frame
  std::vector<double> velocity_costs_;                      ///< T, of the velocity that ends at each frame
  std::vector<double> next_, second_, own_;                 ///< T × n/3 blocks of 9
  Eigen::VectorXd gradient_, shared_gradient_, diagonal_;
  Eigen::MatrixXd shared_;
  Eigen::VectorXd far_shared_diagonal_;  ///< the far couplings' part of the diagonal of shared_
  std::vector<Coupling> couplings_;
  std::vector<std::vector<CouplingOfFrame>> pairs_of_frame_, far_of_frame_;  ///< T, or empty
  std::vector<RowMatrixXd> pair_next_;  ///< T, or empty: n×n of frame t with t + 1, or nothing
  int num_far_rows_ = 0;
  const Eigen::VectorXd* damping_ = nullptr;
  const ChainPrior* prior_ = nullptr;
  Eigen::MatrixXd prior_matrix_;  ///< at the point linearised last
  Eigen::VectorXd prior_gradient_;
  RowMatrixXd prior_next_;                            ///< first frame with the second
  std::vector<std::unique_ptr<Scratch>> evaluators_;  ///< not in use now
  std::mutex evaluators_mutex_;
};

}  // namespace bodyloom
