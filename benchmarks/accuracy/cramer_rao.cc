// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/cramer_rao.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::MatrixXd;

namespace {

/// Frames in groups of `bandwidth`, so that only neighbouring groups couple and the chain is block tridiagonal.
struct Group {
  int begin = 0, count = 0;  ///< frames
  MatrixXd diagonal, next;   ///< of Λ; next couples to the following group
  MatrixXd coupling;         ///< to the shared parameters
};

/// Copies block (a, b), a <= b, of the band into `target`, transposed on request.
void Place(const ClipInformation& information, int a, int b, bool transposed, Eigen::Ref<MatrixXd> target) {
  const int k = b - a;
  if (k >= static_cast<int>(information.band.size())) return;
  if (transposed) {
    target = information.band[k][a].transpose();
  } else {
    target = information.band[k][a];
  }
}

std::vector<Group> GroupFrames(const ClipInformation& information) {
  const int T = information.num_frames();
  const int p = static_cast<int>(information.band[0][0].rows());
  const int s = static_cast<int>(information.shared.rows());
  const int size = std::max<int>(1, static_cast<int>(information.band.size()) - 1);
  std::vector<Group> groups;
  for (int begin = 0; begin < T; begin += size) {
    Group group;
    group.begin = begin;
    group.count = std::min(size, T - begin);
    group.diagonal = MatrixXd::Zero(p * group.count, p * group.count);
    group.coupling = MatrixXd::Zero(p * group.count, s);
    for (int i = 0; i < group.count; ++i) {
      for (int j = 0; j < group.count; ++j) {
        Place(information, begin + std::min(i, j), begin + std::max(i, j), i > j,
              group.diagonal.block(p * i, p * j, p, p));
      }
      if (s > 0) group.coupling.middleRows(p * i, p) = information.coupling[begin + i];
    }
    const int next_begin = begin + group.count, next_count = std::min(size, T - next_begin);
    group.next = MatrixXd::Zero(p * group.count, p * std::max(0, next_count));
    for (int i = 0; i < group.count; ++i) {
      for (int j = 0; j < next_count; ++j) {
        Place(information, begin + i, next_begin + j, false, group.next.block(p * i, p * j, p, p));
      }
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

void CheckBlocks(const ClipInformation& information) {
  BODYLOOM_CHECK(information.num_frames() > 0, "MarginalCovariances: no frames");
  const Eigen::Index T = information.num_frames(), p = information.band[0][0].rows(), s = information.shared.rows();
  for (size_t k = 0; k < information.band.size(); ++k) {
    BODYLOOM_CHECK(static_cast<Eigen::Index>(information.band[k].size()) == std::max<Eigen::Index>(0, T - k),
                   "MarginalCovariances: band ", k, " has ", information.band[k].size(), " blocks for ", T, " frames");
    for (const MatrixXd& block : information.band[k]) {
      BODYLOOM_CHECK(block.rows() == p && block.cols() == p, "MarginalCovariances: a block is ", block.rows(), "x",
                     block.cols(), ", expected ", p, "x", p);
    }
  }
  BODYLOOM_CHECK(information.shared.cols() == s, "MarginalCovariances: shared block is ", s, "x",
                 information.shared.cols());
  BODYLOOM_CHECK(s == 0 || static_cast<Eigen::Index>(information.coupling.size()) == T,
                 "MarginalCovariances: ", information.coupling.size(), " coupling blocks for ", T, " frames");
  for (const MatrixXd& block : information.coupling) {
    BODYLOOM_CHECK(block.rows() == p && block.cols() == s, "MarginalCovariances: a coupling block is ", block.rows(),
                   "x", block.cols(), ", expected ", p, "x", s);
  }
}

/// Factors a symmetric matrix; false when it is not positive definite beyond rounding.
bool Factor(const MatrixXd& matrix, Eigen::LLT<MatrixXd>* factor) {
  factor->compute(matrix);
  return factor->info() == Eigen::Success && matrix.allFinite() && factor->rcond() > 1e-15;
}

/// factor⁻¹ right. Eigen's solver takes the address of the first element, which right sides without columns (the last
/// frame's next, clips without shared parameters) do not have.
MatrixXd Solve(const Eigen::LLT<MatrixXd>& factor, const MatrixXd& right) {
  return right.size() == 0 ? right : MatrixXd(factor.solve(right));
}

MatrixXd Inverse(const Eigen::LLT<MatrixXd>& factor) {
  return factor.solve(MatrixXd::Identity(factor.rows(), factor.cols()));
}

}  // namespace

ClipInformation ClipInformationFromSparse(const Eigen::SparseMatrix<double>& information, int num_frames,
                                          int frame_size) {
  const Eigen::Index n = information.rows(), frames_end = Eigen::Index{num_frames} * frame_size;
  BODYLOOM_CHECK(num_frames > 0 && frame_size > 0 && information.cols() == n && n >= frames_end,
                 "ClipInformationFromSparse: the matrix is ", n, "x", information.cols(), ", expected at least ",
                 num_frames, "·", frame_size, " rows and as many columns");
  const Eigen::Index s = n - frames_end;
  int bandwidth = 0;
  for (Eigen::Index col = 0; col < frames_end; ++col) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(information, col); it; ++it) {
      if (it.row() > col || it.value() == 0) continue;
      bandwidth = std::max(bandwidth, static_cast<int>(col / frame_size - it.row() / frame_size));
    }
  }
  ClipInformation result;
  for (int k = 0; k <= bandwidth; ++k) {
    result.band.emplace_back(num_frames - k, MatrixXd::Zero(frame_size, frame_size));
  }
  result.coupling.assign(num_frames, MatrixXd::Zero(frame_size, s));
  result.shared = MatrixXd::Zero(s, s);
  for (Eigen::Index col = 0; col < n; ++col) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(information, col); it; ++it) {
      const Eigen::Index row = it.row();
      if (row > col || it.value() == 0) continue;
      if (row >= frames_end) {
        result.shared(row - frames_end, col - frames_end) = result.shared(col - frames_end, row - frames_end) =
            it.value();
      } else if (col >= frames_end) {
        result.coupling[row / frame_size](row % frame_size, col - frames_end) = it.value();
      } else {
        const Eigen::Index a = row / frame_size, b = col / frame_size;
        MatrixXd& block = result.band[b - a][a];
        block(row % frame_size, col % frame_size) = it.value();
        if (a == b) block(col % frame_size, row % frame_size) = it.value();
      }
    }
  }
  return result;
}

MatrixXd ClipCovariance::WithShared(int t) const {
  const Eigen::Index p = frame[t].rows(), s = shared.rows();
  MatrixXd joint(p + s, p + s);
  joint << frame[t], cross[t], cross[t].transpose(), shared;
  return joint;
}

ClipCovariance MarginalCovariances(const ClipInformation& information) {
  CheckBlocks(information);
  const int p = static_cast<int>(information.band[0][0].rows());
  const std::vector<Group> groups = GroupFrames(information);
  const size_t n = groups.size();
  ClipCovariance result;

  // Forward: S_i = D_i − U_{i−1}ᵀ S_{i−1}⁻¹ U_{i−1}, W_i = S_i⁻¹ U_i, and Y = Λ_frames⁻¹ coupling on the way.
  std::vector<Eigen::LLT<MatrixXd>> factors(n);
  std::vector<MatrixXd> W(n), Y(n);
  for (size_t i = 0; i < n; ++i) {
    MatrixXd S = groups[i].diagonal;
    Y[i] = groups[i].coupling;
    if (i > 0) {
      S.noalias() -= groups[i - 1].next.transpose() * W[i - 1];
      Y[i].noalias() -= W[i - 1].transpose() * Y[i - 1];
    }
    if (!Factor(S, &factors[i])) {
      result.message = Concatenate("frames ", groups[i].begin, "..", groups[i].begin + groups[i].count - 1,
                                   ": the information matrix is singular, some parameter is not observed");
      return result;
    }
    W[i] = Solve(factors[i], groups[i].next);
  }
  for (size_t i = n; i-- > 0;) {
    Y[i] = Solve(factors[i], Y[i]);
    if (i + 1 < n) Y[i].noalias() -= W[i] * Y[i + 1];
  }

  MatrixXd schur = information.shared;
  for (size_t i = 0; i < n; ++i) schur.noalias() -= groups[i].coupling.transpose() * Y[i];
  if (schur.rows() > 0) {
    Eigen::LLT<MatrixXd> factor;
    if (!Factor(0.5 * (schur + schur.transpose()), &factor)) {
      result.message = "shared parameters: the information matrix is singular, some parameter is not observed";
      return result;
    }
    result.shared = Inverse(factor);
  } else {
    result.shared = schur;
  }

  // Backward: diagonal blocks C_i = S_i⁻¹ + W_i C_{i+1} W_iᵀ of the chain's inverse, plus what the shared ones add.
  MatrixXd C;
  result.frame.resize(information.num_frames());
  result.cross.resize(information.num_frames());
  for (size_t i = n; i-- > 0;) {
    MatrixXd own = Inverse(factors[i]);
    if (i + 1 < n) own.noalias() += W[i] * C * W[i].transpose();
    C = std::move(own);
    for (int f = 0; f < groups[i].count; ++f) {
      const int t = groups[i].begin + f;
      result.frame[t] = C.block(p * f, p * f, p, p);
      result.cross[t].resize(p, result.shared.cols());
      if (result.shared.cols() == 0) continue;  // a matrix without columns has no rows to point into
      const auto y = Y[i].middleRows(p * f, p);
      result.cross[t].noalias() = -y * result.shared;
      result.frame[t].noalias() -= result.cross[t] * y.transpose();
    }
  }
  result.is_finite = true;
  return result;
}

double ExpectedNorm(const Eigen::Matrix2d& covariance) {
  const double mean = 0.5 * covariance.trace();
  const double radius = std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  const double largest = mean + radius, smallest = std::max(0.0, mean - radius);
  if (!(largest > 0)) return 0;
  const double modulus = std::sqrt(std::clamp(1 - smallest / largest, 0.0, 1.0));
  return std::sqrt(2 * largest / std::numbers::pi) * std::comp_ellint_2(modulus);
}

void ProjectionBoundAccumulator::Add(const MatrixXd& J, const MatrixXd& covariance) {
  BODYLOOM_CHECK(J.rows() % 2 == 0 && covariance.rows() == J.cols() && covariance.cols() == J.cols(),
                 "ProjectionBoundAccumulator: Jacobian is ", J.rows(), "x", J.cols(), ", covariance ",
                 covariance.rows(), "x", covariance.cols());
  const MatrixXd JC = J * covariance;
  for (Eigen::Index v = 0; v < J.rows() / 2; ++v) {
    const Eigen::Matrix2d pixel = JC.middleRows(2 * v, 2) * J.middleRows(2 * v, 2).transpose();
    sum_norm_ += ExpectedNorm(pixel);
    sum_square_ += pixel.trace();
    ++num_vertices_;
  }
}

ProjectionBound ProjectionBoundAccumulator::Result(double scale) const {
  ProjectionBound bound;
  bound.num_vertices = num_vertices_;
  if (num_vertices_ == 0) return bound;
  bound.mean_px = scale * sum_norm_ / num_vertices_;
  bound.rms_px = scale * std::sqrt(sum_square_ / num_vertices_);
  return bound;
}

}  // namespace bodyloom
