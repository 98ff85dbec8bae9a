// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/bundle_covariance.h"

#include <ceres/crs_matrix.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kLeastInformation = 1e-9;  ///< of what nothing depends on

/// Jᵀr and JᵀJ of a point's residuals: its own, and those shared with columns of the other blocks.
struct PointSums {
  struct Shared {
    Vector3d normal = Vector3d::Zero();
    double gradient = 0;  ///< of the column
  };
  Matrix3d normal = kLeastInformation * Matrix3d::Identity();
  Vector3d gradient = Vector3d::Zero();
  std::map<int, Shared> columns;
};

/// One residual's derivatives by the other blocks, and the point it depends on.
struct Row {
  std::vector<std::pair<int, double>> others;  ///< column, value
  int point = -1;
  Vector3d by_point = Vector3d::Zero();
};

Row RowOf(const ceres::CRSMatrix& jacobian, int row, int columns) {
  Row result;
  for (int i = jacobian.rows[row]; i < jacobian.rows[row + 1]; ++i) {
    const int column = jacobian.cols[i] - columns;
    if (column < 0) {
      result.others.emplace_back(jacobian.cols[i], jacobian.values[i]);
    } else {
      result.point = column / 3;
      result.by_point[column % 3] = jacobian.values[i];
    }
  }
  return result;
}

/// The covariance of a block's numbers from that of its increments.
MatrixXd OfNumbers(const ceres::Problem& problem, const double* block, const MatrixXd& covariance) {
  const ceres::Manifold* manifold = problem.GetManifold(block);
  if (manifold == nullptr) return covariance;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_increment(manifold->AmbientSize(),
                                                                                      manifold->TangentSize());
  if (!manifold->PlusJacobian(block, by_increment.data())) return covariance;
  return by_increment * covariance * by_increment.transpose();
}

}  // namespace

std::vector<MatrixXd> BundleCovariances(ceres::Problem* problem, const BundleBlocks& blocks, int num_threads) {
  ceres::Problem::EvaluateOptions evaluate;
  evaluate.parameter_blocks = blocks.others;
  evaluate.parameter_blocks.insert(evaluate.parameter_blocks.end(), blocks.points.begin(), blocks.points.end());
  evaluate.num_threads = num_threads;
  std::vector<double> residuals;
  ceres::CRSMatrix jacobian;
  if (!problem->Evaluate(evaluate, nullptr, &residuals, nullptr, &jacobian)) return {};
  std::vector<int> sizes;
  for (const double* block : blocks.others) sizes.push_back(problem->ParameterBlockTangentSize(block));
  const int columns = std::accumulate(sizes.begin(), sizes.end(), 0);
  MatrixXd normal = kLeastInformation * MatrixXd::Identity(columns, columns);
  std::vector<PointSums> points(blocks.points.size());
  std::vector<Row> priors;
  for (int r = 0; r < jacobian.num_rows; ++r) {
    Row row = RowOf(jacobian, r, columns);
    for (const auto& [i, by_i] : row.others) {
      for (const auto& [j, by_j] : row.others) normal(i, j) += by_i * by_j;
    }
    if (row.point < 0) {
      priors.push_back(std::move(row));
      continue;
    }
    PointSums& point = points[size_t(row.point)];
    point.normal += row.by_point * row.by_point.transpose();
    point.gradient += residuals[size_t(r)] * row.by_point;
    for (const auto& [i, by_i] : row.others) {
      PointSums::Shared& shared = point.columns[i];
      shared.normal += by_i * row.by_point;
      shared.gradient += residuals[size_t(r)] * by_i;
    }
  }
  for (const PointSums& point : points) {
    const Matrix3d inverse = point.normal.inverse();
    for (const auto& [i, by_i] : point.columns) {
      const Vector3d solved = inverse * by_i.normal;
      for (const auto& [j, by_j] : point.columns) normal(j, i) -= solved.dot(by_j.normal);
    }
  }
  const MatrixXd inverse = normal.ldlt().solve(MatrixXd::Identity(columns, columns));

  std::vector<MatrixXd> covariances;
  for (const int size : sizes) covariances.emplace_back(MatrixXd::Zero(size, size));
  const auto add = [&](const VectorXd& influence, double weight) {
    for (int at = 0, b = 0; b < static_cast<int>(sizes.size()); at += sizes[size_t(b)], ++b) {
      const auto part = influence.segment(at, sizes[size_t(b)]);
      covariances[size_t(b)] += weight * part * part.transpose();
    }
  };
  const double numbers = double(jacobian.num_rows) - double(priors.size()) - 3.0 * double(points.size());
  const double of_points = std::max(1.0, numbers) / std::max(1.0, numbers - columns);
  for (const PointSums& point : points) {
    const Vector3d solved = point.normal.ldlt().solve(point.gradient);
    VectorXd influence = VectorXd::Zero(columns);
    for (const auto& [column, shared] : point.columns) {
      influence += (shared.gradient - shared.normal.dot(solved)) * inverse.col(column);
    }
    add(influence, of_points);
  }
  for (const Row& prior : priors) {
    VectorXd influence = VectorXd::Zero(columns);
    for (const auto& [column, by] : prior.others) influence += by * inverse.col(column);
    add(influence, 1);
  }
  for (size_t b = 0; b < covariances.size(); ++b) {
    covariances[b] = OfNumbers(*problem, blocks.others[b], covariances[b]);
  }
  return covariances;
}

}  // namespace bodyloom
