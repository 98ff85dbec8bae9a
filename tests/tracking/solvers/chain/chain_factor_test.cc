// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain/chain_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "tracking/problem/panel_simd.h"

namespace bodyloom::chain_factor_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowBlocks = std::vector<double>;

/// A random positive definite matrix of the chain's form, dense and in blocks.
struct RandomChain : ChainSource {
  int T, n, s;
  std::vector<char> cuts;
  MatrixXd M;
  VectorXd b;
  std::vector<RowBlocks> next, second;

  RandomChain(int frames, int frame_size, int shared, std::vector<char> cut_before, uint64_t seed, double damping = 0.1)
      : T(frames), n(frame_size), s(shared), cuts(std::move(cut_before)) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const int N = T * n + s;
    M = damping * MatrixXd::Identity(N, N);
    // Rows as they come in a least-squares problem: a frame with the shared values, and 3×3 blocks over three frames.
    for (int t = 0; t < T; ++t) {
      MatrixXd J = MatrixXd::Zero(n, N);
      J.middleCols(t * n, n) = MatrixXd::NullaryExpr(n, n, [&]() { return normal(random); });
      J.rightCols(s) = MatrixXd::NullaryExpr(n, s, [&]() { return normal(random); });
      M += J.transpose() * J;
      if (t < 2 || cuts[t] || cuts[t - 1]) continue;
      for (int i = 0; i < n; i += 3) {
        MatrixXd A = MatrixXd::Zero(3, N);
        for (int k = 0; k < 3; ++k) {
          A.middleCols((t - k) * n + i, 3) = MatrixXd::NullaryExpr(3, 3, [&]() { return 2 * normal(random); });
        }
        M += A.transpose() * A;
      }
    }
    b = VectorXd::NullaryExpr(N, [&]() { return normal(random); });
    for (int t = 0; t < T; ++t) {
      next.push_back(Blocks(t, t + 1));
      second.push_back(Blocks(t, t + 2));
    }
  }
  RowBlocks Blocks(int t, int u) const {
    RowBlocks blocks;
    if (u >= T) return blocks;
    for (int i = 0; i < n; i += 3) {
      for (int k = 0; k < 9; ++k) blocks.push_back(M(t * n + i + k / 3, u * n + i + k % 3));
    }
    return blocks;
  }
  void AddFrame(int t, double* a, int64_t a_stride, double* y, int64_t y_stride) const override {
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) a[i * a_stride + j] += M(t * n + i, t * n + j);
      for (int j = 0; j < s; ++j) y[i * y_stride + j] += M(t * n + i, T * n + j);
      y[i * y_stride + s] += b[t * n + i];
    }
  }
  const double* Next(int t) const override { return next[t].data(); }
  const double* Second(int t) const override { return second[t].data(); }
  [[nodiscard]] MatrixXd Shared() const { return M.bottomRightCorner(s, s); }
};

/// A positive definite chain of any length without its dense matrix: frames differ, neighbours are coupled weakly.
struct ChainOfLongClip : ChainSource {
  int T, n, s;
  std::vector<char> cuts;
  std::vector<double> blocks;  ///< of one frame: n/3 of 3×3, all entries 0.1

  ChainOfLongClip(int frames, int frame_size, int shared, std::vector<char> cut_before)
      : T(frames),
        n(frame_size),
        s(shared),
        cuts(std::move(cut_before)),
        blocks(static_cast<size_t>(3 * frame_size), 0.1) {}
  void AddFrame(int t, double* a, int64_t a_stride, double* y, int64_t y_stride) const override {
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) a[i * a_stride + j] += i == j ? 4 + std::sin(t + i) : 0.1 * std::cos(t * i - j);
      for (int j = 0; j < s; ++j) y[i * y_stride + j] += 0.01 * std::sin(t - i + 3 * j);
      y[i * y_stride + s] += std::cos(0.7 * t + i);
    }
  }
  const double* Next(int /*t*/) const override { return blocks.data(); }
  const double* Second(int /*t*/) const override { return blocks.data(); }
  [[nodiscard]] MatrixXd Shared() const { return MatrixXd::Identity(s, s) * T; }
};

std::vector<char> CutsAt(int T, const std::vector<int>& at) {
  std::vector<char> cuts(T, 0);
  for (int t : at) cuts[t] = 1;
  return cuts;
}

double RelativeError(const RandomChain& chain, int threads) {
  ChainFactor factor(chain.n, chain.s, chain.cuts);
  VectorXd x, shared;
  if (!factor.Solve(chain, chain.Shared(), chain.b.tail(chain.s), threads, &x, &shared)) return 1e300;
  VectorXd all(x.size() + shared.size());
  all << x, shared;
  return (chain.M * all - chain.b).norm() / chain.b.norm() + (all - chain.M.llt().solve(chain.b)).norm() / all.norm();
}

TEST(ChainFactor, EqualsTheDenseSolution) {
  uint64_t seed = 1;
  for (int n : {3, 6, 9, 24, 75}) {
    for (int s : {0, 1, 7, 11}) {
      for (int T : {1, 2, 3, 4, 5, 8}) {
        if (n == 75 && T > 4) continue;
        EXPECT_LT(RelativeError(RandomChain(T, n, s, CutsAt(T, {}), ++seed), 1), 1e-9) << n << " " << s << " " << T;
      }
    }
  }
}

TEST(ChainFactor, CutsDivideTheChain) {
  uint64_t seed = 100;
  for (const std::vector<int>& at : {std::vector<int>{0}, {1}, {5}, {3, 4, 5}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}) {
    EXPECT_LT(RelativeError(RandomChain(12, 9, 4, CutsAt(12, at), ++seed), 2), 1e-9);
  }
}

TEST(ChainFactor, SameBytesForAnyNumberOfThreads) {
  const RandomChain chain(23, 12, 5, CutsAt(23, {7, 9}), 5);
  VectorXd expected, expected_shared, x, shared;
  ChainFactor factor(chain.n, chain.s, chain.cuts);
  ASSERT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(5), 1, &expected, &expected_shared));
  for (int threads : {2, 3, 8}) {
    ASSERT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(5), threads, &x, &shared));
    EXPECT_EQ(x, expected) << threads;
    EXPECT_EQ(shared, expected_shared) << threads;
  }
}

TEST(ChainFactor, FrozenFramesStayAndTheOthersAreSolvedAlone) {
  const int T = 14, n = 9, s = 4;
  const RandomChain chain(T, n, s, CutsAt(T, {6}), 31);
  ChainFactor factor(n, s, chain.cuts);
  VectorXd x, shared;
  for (const std::vector<int>& at : {std::vector<int>{0, 1, 4, 5, 9, 10, 11}, {13}, {0, 6, 7}, {2, 3, 4, 5, 6, 7, 8}}) {
    factor.SetFrozen(CutsAt(T, at));
    ASSERT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(s), 2, &x, &shared));
    std::vector<int> moving;
    for (int t = 0; t < T; ++t) {
      for (int i = 0; i < n && std::count(at.begin(), at.end(), t) == 0; ++i) moving.push_back(t * n + i);
    }
    const VectorXd expected = MatrixXd(chain.M(moving, moving)).llt().solve(VectorXd(chain.b(moving)));
    EXPECT_LT((x(moving) - expected).norm(), 1e-9 * expected.norm());
    EXPECT_NEAR(x.squaredNorm(), expected.squaredNorm(), 1e-9 * expected.squaredNorm()) << "a frozen frame moved";
    EXPECT_EQ(shared, VectorXd::Zero(s));
  }
  factor.SetFrozen({});
  ASSERT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(s), 2, &x, &shared));
  EXPECT_LT((x - chain.M.llt().solve(chain.b).head(T * n)).norm(), 1e-9 * x.norm());
  EXPECT_THROW(factor.SetFrozen(std::vector<char>(T + 1)), std::invalid_argument);
  EXPECT_THROW(factor.SetFrozen(CutsAt(T, {3})), std::invalid_argument);
}

TEST(ChainFactor, SaysWhenTheMatrixIsNotPositiveDefinite) {
  RandomChain chain(6, 6, 3, CutsAt(6, {}), 9);
  ChainFactor factor(chain.n, chain.s, chain.cuts);
  VectorXd x, shared;
  for (int bad : {0, 13, 20, 35, 38}) {  // ends, middle, shared
    RandomChain broken = chain;
    broken.M(bad, bad) = -1;
    EXPECT_FALSE(factor.Solve(broken, broken.Shared(), broken.b.tail(3), 1, &x, &shared)) << bad;
    broken.M(bad, bad) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(factor.Solve(broken, broken.Shared(), broken.b.tail(3), 1, &x, &shared)) << bad;
  }
  EXPECT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(3), 1, &x, &shared));
}

TEST(ChainFactor, NearlySingularSystemsKeepASmallResidual) {
  for (double damping : {1e-3, 1e-6, 1e-9}) {
    RandomChain chain(7, 9, 4, CutsAt(7, {}), 3, damping);
    // One value that nothing sees: only the damping holds it.
    const int hidden = 4 * 9 + 2;
    chain.M.row(hidden).setZero();
    chain.M.col(hidden).setZero();
    chain.M(hidden, hidden) = damping;
    chain.b[hidden] = 0;
    for (int t = 0; t < 7; ++t) {
      chain.next[t] = chain.Blocks(t, t + 1);
      chain.second[t] = chain.Blocks(t, t + 2);
    }
    ChainFactor factor(9, 4, chain.cuts);
    VectorXd x, shared, all(67);
    ASSERT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(4), 1, &x, &shared));
    all << x, shared;
    EXPECT_LT((chain.M * all - chain.b).norm(), 1e-9 * chain.b.norm());
    EXPECT_EQ(all[hidden], 0);
  }
}

/// Largest difference between the blocks that VisitInverse hands out and the dense inverse, relative to the largest
/// entry of the latter; counts the frames.
double InverseError(const RandomChain& chain, int begin, int end, int threads, int* visited) {
  ChainFactor factor(chain.n, chain.s, chain.cuts);
  VectorXd x, shared;
  if (!factor.Solve(chain, chain.Shared(), chain.b.tail(chain.s), threads, &x, &shared)) return 1e300;
  const int n = chain.n, s = chain.s;
  const MatrixXd dense = chain.M.llt().solve(MatrixXd::Identity(chain.M.rows(), chain.M.rows()));
  std::vector<double> errors(chain.T, -1);
  factor.VisitInverse(begin, end, threads, [&](int t, const MatrixXd& P) {
    MatrixXd expected(n + s, n + s);
    expected << dense.block(t * n, t * n, n, n), dense.block(t * n, chain.T * n, n, s),
        dense.block(chain.T * n, t * n, s, n), dense.bottomRightCorner(s, s);
    errors[t] = (P - expected).cwiseAbs().maxCoeff() / dense.cwiseAbs().maxCoeff();
  });
  for (int t = 0; t < chain.T; ++t) EXPECT_EQ(errors[t] >= 0, t >= begin && t < end) << t;
  *visited += static_cast<int>(std::count_if(errors.begin(), errors.end(), [](double e) { return e >= 0; }));
  return *std::max_element(errors.begin(), errors.end());
}

TEST(ChainInverse, EqualsTheDenseInverse) {
  uint64_t seed = 300;
  int visited = 0, expected = 0;
  for (int n : {3, 6, 9, 24, 75}) {
    for (int s : {0, 1, 7, 11}) {
      for (int T : {1, 2, 3, 4, 5, 8}) {
        if (n == 75 && T > 5) continue;
        EXPECT_LT(InverseError(RandomChain(T, n, s, CutsAt(T, {}), ++seed), 0, T, 2, &visited), 1e-9)
            << n << " " << s << " " << T;
        expected += T;
      }
    }
  }
  EXPECT_EQ(visited, expected);
}

TEST(ChainInverse, CutsAndPartsOfTheClip) {
  uint64_t seed = 400;
  int visited = 0;
  for (const std::vector<int>& at : {std::vector<int>{}, {0}, {1}, {5}, {3, 4, 5}, {11}}) {
    const RandomChain chain(12, 9, 4, CutsAt(12, at), ++seed);
    for (const auto& [begin, end] : {std::pair(0, 12), {0, 1}, {11, 12}, {4, 7}, {5, 6}, {6, 6}, {2, 9}}) {
      EXPECT_LT(InverseError(chain, begin, end, 1, &visited), 1e-10) << begin << " " << end;
    }
  }
  EXPECT_EQ(visited, 6 * (12 + 1 + 1 + 3 + 1 + 7));
}

TEST(ChainInverse, SameBytesForAnyNumberOfThreads) {
  const RandomChain chain(23, 12, 5, CutsAt(23, {7, 9}), 5);
  ChainFactor factor(chain.n, chain.s, chain.cuts);
  VectorXd x, shared;
  std::vector<MatrixXd> expected(23), blocks(23);
  for (int threads : {1, 2, 5}) {
    ASSERT_TRUE(factor.Solve(chain, chain.Shared(), chain.b.tail(5), threads, &x, &shared));
    factor.VisitInverse(0, 23, threads, [&](int t, const MatrixXd& P) { blocks[t] = P; });
    if (threads == 1) expected = blocks;
    for (int t = 0; t < 23; ++t) EXPECT_EQ(blocks[t], expected[t]) << threads;
  }
}

TEST(ChainFactor, RowsThatAreComputedAgainHaveTheSameBits) {
  // Longer than a block on both sides of the middle, with frames left over; and two segments.
  for (const std::vector<int>& at : {std::vector<int>{}, {301}}) {
    const int T = 2 * ChainFactor::kBlock * 2 + 37;
    const ChainOfLongClip chain(T, 6, 3, CutsAt(T, at));
    ChainFactor all(chain.n, chain.s, chain.cuts, 0, T), few(chain.n, chain.s, chain.cuts, 0, 20);
    VectorXd x, shared, again, shared_again;
    const VectorXd rhs = VectorXd::Constant(chain.s, 0.5);
    ASSERT_TRUE(all.Solve(chain, chain.Shared(), rhs, 2, &x, &shared));
    for (int threads : {1, 3}) {
      ASSERT_TRUE(few.Solve(chain, chain.Shared(), rhs, threads, &again, &shared_again));
      EXPECT_EQ(x, again);
      EXPECT_EQ(shared, shared_again);
    }
    std::vector<MatrixXd> expected(T), blocks(T);
    all.VisitInverse(0, T, 2, [&](int t, const MatrixXd& P) { expected[t] = P; });
    few.VisitInverse(0, T, 2, [&](int t, const MatrixXd& P) { blocks[t] = P; });
    EXPECT_EQ(expected, blocks);
    int visited = 0;
    few.VisitInverse(40, 45, 2, [&](int t, const MatrixXd& P) {
      EXPECT_EQ(P, expected[t]);
      ++visited;
    });
    EXPECT_EQ(visited, 5);
  }
}

TEST(PanelKernels, EveryInstructionSetAgrees) {
  const RandomChain chain(9, 33, 6, CutsAt(9, {}), 77);
  const VectorXd expected = chain.M.llt().solve(chain.b);
  int tried = 0;
  for (int64_t target : panel_internal::SimdTargets()) {
    panel_internal::ForceSimdTarget(target);
    EXPECT_LT(RelativeError(chain, 1), 1e-10) << panel_internal::SimdTargetName(target);
    int visited = 0;
    EXPECT_LT(InverseError(chain, 0, 9, 1, &visited), 1e-11) << panel_internal::SimdTargetName(target);
    ++tried;
  }
  panel_internal::ForceSimdTarget(0);
  EXPECT_GE(tried, 1);
}

TEST(PanelKernels, ProductsEqualTheirFormula) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  for (int rows : {1, 2, 3, 4, 5, 11}) {
    for (int columns : {8, 16, 24, 32, 40}) {
      const int depth = 7, lda = 16, ldb = 48, ldc = 40;
      std::vector<double> a(depth * lda), b(depth * ldb), c(rows * ldc, 0.5);
      for (double& x : a) x = normal(random);
      for (double& x : b) x = normal(random);
      panel_internal::Products p;
      p.a = a.data();
      p.b = b.data();
      p.c = c.data();
      p.lda = lda;
      p.ldb = ldb;
      p.ldc = ldc;
      p.rows = rows;
      p.columns = columns;
      p.first = 2;
      p.last = depth;
      p.sign = -1;
      panel_internal::AddProducts(p);
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < ldc; ++j) {
          double expected = 0.5;
          for (int m = 2; m < depth && j < columns; ++m) expected -= a[m * lda + i] * b[m * ldb + j];
          EXPECT_NEAR(c[i * ldc + j], expected, 1e-13);
        }
      }
    }
  }
}

}  // namespace
}  // namespace bodyloom::chain_factor_test
