// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/makehuman_skinning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "bodyloom/data_tools/body_making/nonnegative_least_squares.h"
#include "bodyloom/geometry/body_model.h"

namespace bodyloom {
namespace {

constexpr int kJoints = 24;
constexpr int kMaxInfluences = 4;
constexpr int kSmoothingSteps = 14;
constexpr double kSpineStep_m = 0.023;
constexpr size_t kMinRegressorVertices = 30, kMaxRegressorVertices = 120;
constexpr double kRidge = 2e-2;  // of the mean diagonal of AᵀA
constexpr int kTorso = -1;

/// The joint that a bone's weight goes to, kTorso for pelvis and spine.
int JointOfBone(std::string_view bone) {
  const int right = bone.ends_with("_r") ? 1 : 0;
  const auto is = [&](std::string_view prefix) { return bone.starts_with(prefix); };
  if (is("thigh")) return 1 + right;
  if (is("calf")) return 4 + right;
  if (is("foot")) return 7 + right;
  if (is("ball")) return 10 + right;
  if (is("neck")) return 12;
  if (is("clavicle")) return 13 + right;
  if (is("head")) return 15;
  if (is("upperarm")) return 16 + right;
  if (is("lowerarm")) return 18 + right;
  if (is("hand") || is("thumb")) return 20 + right;
  if (is("index") || is("middle") || is("ring") || is("pinky")) return 22 + right;
  return kTorso;
}

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

/// One half-step: halfway to the mean of the neighbours.
RowMatrixXd Smooth(const RowMatrixXd& values, const std::vector<Edge>& edges) {
  RowMatrixXd sums = RowMatrixXd::Zero(values.rows(), values.cols());
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(values.rows());
  for (const Edge& edge : edges) {
    for (int k = 0; k < 2; ++k) {
      sums.row(edge[k]) += values.row(edge[1 - k]);
      counts[edge[k]] += 1;
    }
  }
  RowMatrixXd smooth = values;
  for (Eigen::Index v = 0; v < values.rows(); ++v) {
    if (counts[v] > 0) smooth.row(v) = 0.5 * (values.row(v) + sums.row(v) / counts[v]);
  }
  return smooth;
}

std::vector<Edge> EdgesOf(const std::vector<Quad>& quads) {
  std::vector<Edge> edges;
  for (const Quad& quad : quads) {
    for (int k = 0; k < 4; ++k)
      edges.push_back({std::min(quad[k], quad[(k + 1) % 4]), std::max(quad[k], quad[(k + 1) % 4])});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

/// Whether the points lie on all sides of the origin: in each of the 26 directions of a cube's corners, edges and faces
/// there is one within about 60°.
bool Surround(const std::vector<Eigen::RowVector3d>& points) {
  for (int code = 0; code < 27; ++code) {
    const int x = code % 3 - 1, y = code / 3 % 3 - 1, z = code / 9 - 1;
    const Eigen::RowVector3d direction(x, y, z);
    if (code == 13) continue;  // no direction
    const bool seen = std::any_of(points.begin(), points.end(), [&](const Eigen::RowVector3d& point) {
      return point.dot(direction) > 0.5 * point.norm() * direction.norm();
    });
    if (!seen) return false;
  }
  return true;
}

/// The vertices that a joint is regressed from: those that move with it or its neighbours in the tree, from the
/// smallest ball around it in which they lie on all sides, evenly spread.
std::vector<int> RegressorVertices(int joint, const MatrixX3d& mean, const Eigen::RowVector3d& position,
                                   const SparseRows& weights) {
  const int parent = SmplParents()[joint];
  std::vector<std::pair<double, int>> near;
  for (int v = 0; v < weights.rows(); ++v) {
    double share = 0;
    for (SparseRows::InnerIterator it(weights, v); it; ++it) {
      const int j = static_cast<int>(it.col());
      if (j == joint || j == parent || SmplParents()[j] == joint) share += it.value();
    }
    if (share > 0.3) near.emplace_back((mean.row(v) - position).norm(), v);
  }
  if (near.empty()) return {};
  std::sort(near.begin(), near.end());
  size_t count = 0;
  std::vector<Eigen::RowVector3d> inside;
  for (double radius = 1.3 * near[0].first; count < near.size(); radius *= 1.1) {
    for (; count < near.size() && near[count].first <= radius; ++count) {
      inside.push_back(mean.row(near[count].second) - position);
    }
    if (count >= kMinRegressorVertices && Surround(inside)) break;
  }
  near.resize(count);
  // Farthest-point sampling.
  std::vector<int> chosen;
  std::vector<double> gap(near.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < std::min(kMaxRegressorVertices, near.size())) {
    const size_t next =
        chosen.empty() ? 0 : static_cast<size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
    chosen.push_back(near[next].second);
    for (size_t i = 0; i < near.size(); ++i) {
      gap[i] = std::min(gap[i], (mean.row(near[i].second) - mean.row(chosen.back())).squaredNorm());
    }
  }
  return chosen;
}

}  // namespace

SparseRows SmplWeightsFromMakeHuman(const MakeHumanFiles& files, const MatrixX3d& vertices, const MatrixX3d& joints) {
  RowMatrixXd weights = RowMatrixXd::Zero(files.num_body_vertices, kJoints);
  const int spine[3] = {3, 6, 9};
  for (int v = 0; v < files.num_body_vertices; ++v) {
    double torso = 0;
    for (SparseRows::InnerIterator it(files.bone_weights, v); it; ++it) {
      const int joint = JointOfBone(files.bones[it.col()].name);
      (joint == kTorso ? torso : weights(v, joint)) += it.value();
    }
    int below = 0;  // pelvis, then the spine joints
    for (int joint : spine) {
      const double above = Logistic((vertices(v, 1) - joints(joint, 1)) / kSpineStep_m);
      weights(v, below) += torso * (1 - above);
      torso *= above;
      below = joint;
    }
    weights(v, below) += torso;
  }
  const std::vector<Edge> edges = EdgesOf(files.quads);
  for (int step = 0; step < kSmoothingSteps; ++step) weights = Smooth(weights, edges);

  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < files.num_body_vertices; ++v) {
    std::vector<int> order(kJoints);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return weights(v, a) > weights(v, b); });
    double sum = 0;
    for (int k = 0; k < kMaxInfluences; ++k) sum += weights(v, order[k]);
    for (int k = 0; k < kMaxInfluences; ++k) {
      if (weights(v, order[k]) > 1e-4) entries.emplace_back(v, order[k], weights(v, order[k]) / sum);
    }
  }
  SparseRows sparse(files.num_body_vertices, kJoints);
  sparse.setFromTriplets(entries.begin(), entries.end());
  return sparse;
}

SparseRows FitJointRegressor(const std::vector<MatrixX3d>& people, const std::vector<MatrixX3d>& joints,
                             const SparseRows& weights, std::vector<double>* mean_error) {
  const auto count = static_cast<double>(people.size());
  MatrixX3d mean = MatrixX3d::Zero(weights.rows(), 3), mean_joints = MatrixX3d::Zero(kJoints, 3);
  for (size_t i = 0; i < people.size(); ++i) {
    mean += people[i] / count;
    mean_joints += joints[i] / count;
  }
  std::vector<Eigen::Triplet<double>> entries;
  mean_error->assign(kJoints, 0);
  for (int j = 0; j < kJoints; ++j) {
    const std::vector<int> chosen = RegressorVertices(j, mean, mean_joints.row(j), weights);
    const auto n = static_cast<Eigen::Index>(chosen.size());
    const auto rows = static_cast<Eigen::Index>(3 * people.size());
    Eigen::MatrixXd A(rows, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(rows);
    for (size_t i = 0; i < people.size(); ++i) {
      for (Eigen::Index k = 0; k < n; ++k) {
        A.block<3, 1>(static_cast<Eigen::Index>(3 * i), k) = (people[i].row(chosen[k]) - joints[i].row(j)).transpose();
      }
    }
    // Around the joint as origin the target is zero and the weights sum to 1: a heavy row of ones asks for the sum.
    Eigen::MatrixXd AtA = A.transpose() * A;
    const double scale = AtA.diagonal().mean();
    AtA.diagonal().array() += kRidge * scale;
    const double sum_weight = 1e4 * scale;
    AtA.array() += sum_weight;
    Eigen::VectorXd x = SolveNonnegative(AtA, Eigen::VectorXd::Constant(n, sum_weight));
    x /= x.sum();
    for (Eigen::Index k = 0; k < n; ++k) {
      if (x[k] > 1e-5) entries.emplace_back(j, chosen[k], x[k]);
    }
    const Eigen::VectorXd residual = A * x;
    for (size_t i = 0; i < people.size(); ++i) {
      (*mean_error)[j] += residual.segment<3>(static_cast<Eigen::Index>(3 * i)).norm() / count;
    }
  }
  SparseRows regressor(kJoints, weights.rows());
  regressor.setFromTriplets(entries.begin(), entries.end());
  for (int j = 0; j < kJoints; ++j) regressor.row(j) /= regressor.row(j).sum();
  return regressor;
}

}  // namespace bodyloom
