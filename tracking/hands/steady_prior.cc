// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/steady_prior.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tracking/solvers/residuals/ceres_functions.h"

namespace bodyloom {
namespace {

double Covariance(double seconds, double length_s) {
  const double d = std::sqrt(3.0) * seconds / length_s;
  return std::isfinite(d) ? (1 + d) * std::exp(-d) : 0;
}

}  // namespace

SteadyStep SteadyStepOf(double to_last_s, double to_before_s, double length_s) {
  const double last = Covariance(to_last_s, length_s), before = Covariance(to_before_s, length_s);
  const double between = std::isfinite(to_before_s) ? Covariance(to_before_s - to_last_s, length_s) : 0;
  const Eigen::Matrix2d K = (Eigen::Matrix2d() << 1, between, between, 1).finished();
  const Eigen::Vector2d k(last, before), weights = K.inverse() * k;
  return {weights[0], weights[1], std::sqrt(std::max(1e-12, 1 - k.dot(weights)))};
}

void AddSteadyPrior(const SteadyPrior& prior, const std::vector<double*>& blocks, int size,
                    const std::vector<double>& times_s, const std::vector<char>& cut_before, ceres::Problem* problem) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  int before = 0;  // frames since the last cut, up to two
  for (size_t t = 0; t < blocks.size(); ++t) {
    if (cut_before[t] != 0) before = 0;
    const SteadyStep step = SteadyStepOf(before > 0 ? times_s[t] - times_s[t - 1] : kNever,
                                         before > 1 ? times_s[t] - times_s[t - 2] : kNever, prior.length_s);
    const int columns = size * (1 + before);
    RowMatrixXd A = RowMatrixXd::Zero(size, columns);
    const double weight = 1 / (step.sigma * prior.sigma);
    A.leftCols(size).diagonal().setConstant(weight);
    std::vector<double*> read = {blocks[t]};
    if (before > 0) {
      A.middleCols(size, size).diagonal().setConstant(-step.last * weight);
      read.push_back(blocks[t - 1]);
    }
    if (before > 1) {
      A.rightCols(size).diagonal().setConstant(-step.before * weight);
      read.push_back(blocks[t - 2]);
    }
    problem->AddResidualBlock(
        new LinearCost(std::move(A), Eigen::VectorXd::Zero(size), std::vector<int>(read.size(), size)), nullptr, read);
    before = std::min(before + 1, 2);
  }
}

double IndependentShare(size_t t, const std::vector<double>& times_s, const std::vector<char>& cut_before,
                        double last_s) {
  double step_s = std::numeric_limits<double>::infinity();
  if (t > 0 && cut_before[t] == 0) step_s = times_s[t] - times_s[t - 1];
  if (t + 1 < times_s.size() && cut_before[t + 1] == 0) step_s = std::min(step_s, times_s[t + 1] - times_s[t]);
  const double alike = std::exp(-step_s / last_s);
  return (1 - alike) / (1 + alike);
}

}  // namespace bodyloom
