// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain/chain_inverse.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/math/arrays.h"
#include "tracking/problem/panel_simd.h"
#include "tracking/solvers/chain/chain_factor.h"

namespace bodyloom {

using panel_internal::Products;
using panel_internal::RoundUp;

/// The inverse at two neighbours in the order of elimination, and the way from them to the frame eliminated before.
/// Squares are n rows of stride_ values, padded with zeros; C is the inverse given the shared values.
class ChainFactor::Inverse {
 public:
  explicit Inverse(const ChainFactor& factor)
      : f_(factor), n_(factor.n_), stride_(panel_internal::RowStride(n_)), arrow_(RoundUp(factor.s_ + 1)) {
    for (Square* square : {&U_, &V_, &W1_, &W2_, &K1t_, &K2t_, &near_, &far_, &far_near_, &near_far_, &new_near_,
                           &near_new_, &far_new_}) {
      square->assign(static_cast<size_t>(n_ * stride_), 0.0);
    }
    for (Square* rows : {&Y_, &near_G_, &far_G_, &new_G_}) rows->assign(static_cast<size_t>(n_ * arrow_), 0.0);
  }

  /// Goes to the frame of these rows, which couple it to no frame (0), to the near one (1), or to the near one and the
  /// far one (2). It becomes the near one, and the near one the far one.
  void Step(const std::vector<double>& rows, int neighbours);
  /// Exchanges near and far, to go on from the other end.
  void Turn() {
    near_.swap(far_);
    near_far_.swap(far_near_);
    near_G_.swap(far_G_);
  }
  /// P of the near frame.
  void Near(const Eigen::MatrixXd& shared_inverse, Eigen::MatrixXd* P) const;

 private:
  using Square = std::vector<double>;

  void Unpack(const std::vector<double>& rows, bool second);
  /// V = U⁻ᵀ, lower triangular.
  void Invert();
  /// c += sign aᵀb; `columns` of rows that are `stride` apart in b and c.
  void Add(const Square& a, const Square& b, int columns, int64_t stride, double sign, Square* c, bool b_lower = false,
           bool upper = false) const {
    Products p;
    p.a = a.data();
    p.b = b.data();
    p.c = c->data();
    p.lda = stride_;
    p.ldb = p.ldc = stride;
    p.rows = p.last = n_;
    p.columns = columns;
    p.sign = sign;
    p.b_lower = b_lower;
    p.upper = upper;
    panel_internal::AddProducts(p);
  }
  void Clear(Square* square) const { std::fill(square->begin(), square->end(), 0.0); }

  const ChainFactor& f_;
  int n_;
  int64_t stride_, arrow_;
  Square U_, V_, W1_, W2_, Y_, K1t_, K2t_;
  Square near_, far_, far_near_, near_far_;  ///< C; far_near_ has the far frame's rows
  Square new_near_, near_new_, far_new_;
  Square near_G_, far_G_, new_G_;
};

/// Pool of unused scratch memory.
class ChainFactor::InversePool {
 public:
  std::unique_ptr<Inverse> Take(const ChainFactor& factor) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (spare_.empty()) return std::make_unique<Inverse>(factor);
    std::unique_ptr<Inverse> inverse = std::move(spare_.back());
    spare_.pop_back();
    return inverse;
  }
  void Return(std::unique_ptr<Inverse> inverse) {
    const std::lock_guard<std::mutex> lock(mutex_);
    spare_.push_back(std::move(inverse));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Inverse>> spare_;
};

void ChainFactor::Inverse::Unpack(const std::vector<double>& rows, bool second) {
  const double* from = rows.data();
  const auto take = [&](int count, double* to) {
    std::copy_n(from, count, to);
    from += count;
  };
  for (int k = 0; k < n_; ++k) {
    const int lower = k / 3 * 3 + 3;
    take(n_ - k, &U_[k * stride_ + k]);
    take(n_, &W1_[k * stride_]);
    take(f_.s_, &Y_[k * arrow_]);
    ++from;  // the right-hand side
    if (second) std::copy_n(from, lower, &W2_[k * stride_]);
    from += lower;
  }
}

void ChainFactor::Inverse::Invert() {
  Clear(&V_);
  constexpr int kRows = 4;
  for (int k = 0; k < n_; k += kRows) {
    const int rows = std::min(kRows, n_ - k);
    for (int i = k; i < k + rows; ++i) V_[i * stride_ + i] = 1;
    Products p;
    p.a = U_.data() + k;
    p.b = V_.data();
    p.c = V_.data() + k * stride_;
    p.lda = p.ldb = p.ldc = stride_;
    p.rows = rows;
    p.columns = p.last = k;
    p.sign = -1;
    p.b_lower = true;
    if (k > 0) panel_internal::AddProducts(p);
    for (int i = k; i < k + rows; ++i) {
      double* row = &V_[i * stride_];
      for (int m = k; m < i; ++m) {
        const double* above = &V_[m * stride_];
        for (int j = 0; j <= m; ++j) row[j] -= U_[m * stride_ + i] * above[j];
      }
      for (int j = 0; j <= i; ++j) row[j] /= U_[i * stride_ + i];
    }
  }
}

void ChainFactor::Inverse::Step(const std::vector<double>& rows, int neighbours) {
  Unpack(rows, neighbours == 2);
  Invert();
  for (Square* square : {&new_near_, &near_new_, &far_new_, &new_G_}) Clear(square);
  Add(V_, V_, n_, stride_, 1, &new_near_, true, true);
  Add(V_, Y_, f_.s_, arrow_, -1, &new_G_);
  if (neighbours >= 1) {
    Clear(&K1t_);
    Add(W1_, V_, n_, stride_, 1, &K1t_, true);
    Add(near_, K1t_, n_, stride_, -1, &near_new_);
    Add(K1t_, near_G_, f_.s_, arrow_, -1, &new_G_);
  }
  if (neighbours == 2) {
    Clear(&K2t_);
    Add(W2_, V_, n_, stride_, 1, &K2t_, true);
    Add(far_near_, K2t_, n_, stride_, -1, &near_new_);
    Add(near_far_, K1t_, n_, stride_, -1, &far_new_);
    Add(far_, K2t_, n_, stride_, -1, &far_new_);
    Add(K2t_, far_new_, n_, stride_, -1, &new_near_, false, true);
    Add(K2t_, far_G_, f_.s_, arrow_, -1, &new_G_);
  }
  if (neighbours >= 1) Add(K1t_, near_new_, n_, stride_, -1, &new_near_, false, true);
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < i; ++j) new_near_[i * stride_ + j] = new_near_[j * stride_ + i];
  }
  far_.swap(near_);
  near_.swap(new_near_);
  far_G_.swap(near_G_);
  near_G_.swap(new_G_);
  far_near_.swap(near_new_);
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j < n_; ++j) near_far_[j * stride_ + i] = far_near_[i * stride_ + j];
  }
}

void ChainFactor::Inverse::Near(const Eigen::MatrixXd& shared_inverse, Eigen::MatrixXd* P) const {
  using Rows = Eigen::Map<const RowMatrixXd, 0, Eigen::OuterStride<>>;
  const int s = f_.s_;
  const Rows C(near_.data(), n_, n_, Eigen::OuterStride<>(stride_));
  const Rows G(near_G_.data(), n_, s, Eigen::OuterStride<>(arrow_));
  P->resize(n_ + s, n_ + s);
  P->topLeftCorner(n_, n_) = C;
  if (s == 0) return;
  P->topRightCorner(n_, s).noalias() = G * shared_inverse;
  P->topLeftCorner(n_, n_).noalias() += P->topRightCorner(n_, s) * G.transpose();
  P->bottomLeftCorner(s, n_) = P->topRightCorner(n_, s).transpose();
  P->bottomRightCorner(s, s) = shared_inverse;
}

std::shared_ptr<ChainFactor::InversePool> ChainFactor::MakeInversePool() { return std::make_shared<InversePool>(); }

void ChainFactor::VisitInverse(int begin, int end, int num_threads,
                               const std::function<void(int, const Eigen::MatrixXd&)>& visit,
                               const Eigen::MatrixXd* shared_inverse) const {
  BODYLOOM_CHECK(begin >= 0 && end <= num_frames(), "chain: the inverse of frames ", begin, " to ", end, " of ",
                 num_frames());
  const Eigen::MatrixXd& of_shared = shared_inverse == nullptr ? shared_inverse_ : *shared_inverse;
  BODYLOOM_CHECK(of_shared.rows() == s_ && of_shared.cols() == s_, "chain: the inverse of ", of_shared.rows(), " x ",
                 of_shared.cols(), " shared values, expected ", s_);
  const std::vector<Segment> segments = Segments();
  ParallelFor(2 * static_cast<int>(segments.size()), num_threads, [&](int i) {
    const Segment& segment = segments[i / 2];
    const int m = segment.middle, first_after = std::min(m + 2, segment.end);
    const bool ahead = i % 2 == 0;
    const int from = std::max(begin, ahead ? segment.begin : first_after);
    const int to = std::min(end, ahead ? first_after : segment.end);
    if (from >= to) return;
    std::unique_ptr<Inverse> scratch = inverses_->Take(*this);
    Inverse& inverse = *scratch;
    Eigen::MatrixXd P;
    const auto hand_over = [&](int t) {
      if (t < from || t >= to) return;
      inverse.Near(of_shared, &P);
      visit(t, P);
    };
    if (m + 1 < segment.end) {
      inverse.Step(factor_[m + 1], 0);
      hand_over(m + 1);
    }
    inverse.Step(factor_[m], m + 1 < segment.end ? 1 : 0);
    hand_over(m);
    if (!ahead) inverse.Turn();
    VisitRows(i, [&](int t, const std::vector<double>& rows) {
      if (ahead ? t < from : t >= to) return false;
      inverse.Step(rows, 2);
      hand_over(t);
      return true;
    });
    inverses_->Return(std::move(scratch));
  });
}

bool VisitCovariance(ChainProblem* chain, ChainFactor* factor, int begin, int end, int num_threads,
                     const std::function<void(int, const Eigen::MatrixXd&)>& visit,
                     const Eigen::MatrixXd* shared_covariance) {
  BODYLOOM_CHECK(shared_covariance == nullptr || chain->num_far_rows() == 0,
                 "chain: a covariance of the shared values beside cost functions on several frames");
  constexpr double kNothing = 1e-6;
  const Eigen::VectorXd hold = Eigen::VectorXd::Constant(chain->gradient().size(), kNothing);
  chain->SetDamping(&hold);
  Eigen::VectorXd step, shared_step;
  const Eigen::MatrixXd arrow = chain->Arrow(Eigen::VectorXd::Zero(chain->shared_size()));
  const bool solved =
      factor->Solve(*chain, arrow, Eigen::VectorXd::Zero(chain->arrow_size()), num_threads, &step, &shared_step);
  const int size = chain->frame_size() + chain->shared_size();
  if (solved && chain->num_far_rows() == 0) {
    factor->VisitInverse(begin, end, num_threads, visit, shared_covariance);
  } else if (solved) {  // without multipliers
    factor->VisitInverse(begin, end, num_threads,
                         [&](int t, const Eigen::MatrixXd& P) { visit(t, P.topLeftCorner(size, size)); });
  }
  chain->SetDamping(nullptr);  // not before: rows that were not kept are computed again
  return solved;
}

}  // namespace bodyloom
