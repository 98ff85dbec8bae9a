// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/procrustes.h"

namespace bodyloom {
namespace {

constexpr double kSigmaOfSpacing = 0.6;

using Eigen::Vector3d;

bool IsNearOne(const Vector3d& point, const std::vector<Vector3d>& others, double distance) {
  return std::any_of(others.begin(), others.end(),
                     [&](const Vector3d& other) { return (other - point).squaredNorm() < distance * distance; });
}

}  // namespace

ClothNodes::ClothNodes(const LooseGarment& garment, double spacing_m)
    : spacing_m_(spacing_m), num_vertices_(garment.sewn.size()) {
  BODYLOOM_CHECK(!garment.empty(), "nodes on cloth: the garment has no vertices");
  BODYLOOM_CHECK(spacing_m > 0 && spacing_m <= 1, "nodes on cloth: ", spacing_m, " m apart, expected (0, 1]");
  std::vector<Vector3d> nodes;
  for (size_t v = 0; v < garment.sewn.size(); ++v) {
    if (IsNearOne(garment.sewn[v], nodes, spacing_m)) continue;
    nodes.push_back(garment.sewn[v]);
    vertices_.push_back(static_cast<int>(v));
  }
  places_.resize(static_cast<Eigen::Index>(nodes.size()), 3);
  const double reach = kReach * spacing_m;
  for (size_t k = 0; k < nodes.size(); ++k) {
    places_.row(static_cast<Eigen::Index>(k)) = nodes[k].transpose();
    std::vector<int>& around = around_.emplace_back();
    for (size_t v = 0; v < garment.sewn.size(); ++v) {
      if ((garment.sewn[v] - nodes[k]).squaredNorm() <= reach * reach) around.push_back(static_cast<int>(v));
    }
    MatrixX3d& sewn = around_as_sewn_.emplace_back(static_cast<Eigen::Index>(around.size()), 3);
    for (size_t i = 0; i < around.size(); ++i) {
      sewn.row(static_cast<Eigen::Index>(i)) = garment.sewn[around[i]].transpose();
    }
  }
}

MovedNodes ClothNodes::Move(std::span<const Vector3d> cloth) const {
  BODYLOOM_CHECK(cloth.size() == num_vertices_, "nodes on cloth: ", cloth.size(), " vertices, expected ",
                 num_vertices_);
  MovedNodes moved;
  moved.places.resize(size(), 3);
  AlignmentOptions rigid;
  rigid.estimate_scale = false;
  for (int k = 0; k < size(); ++k) {
    moved.places.row(k) = cloth[vertices_[k]].transpose();
    MatrixX3d now(around_as_sewn_[k].rows(), 3);
    for (Eigen::Index i = 0; i < now.rows(); ++i) now.row(i) = cloth[around_[k][i]].transpose();
    const AlignmentResult aligned = AlignPoints(around_as_sewn_[k], now, rigid);
    if (aligned.status == AlignmentStatus::kUnique) {
      moved.rotations.push_back(aligned.target_from_source.rotation);
    } else {
      moved.rotations.push_back(k > 0 ? moved.rotations.back() : Eigen::Matrix3d::Identity());
    }
  }
  return moved;
}

NearestNodes ClothNodes::Near(const Vector3d& point) const {
  std::vector<std::pair<double, int>> order;
  order.reserve(size());
  for (int k = 0; k < size(); ++k) order.emplace_back((places_.row(k).transpose() - point).squaredNorm(), k);
  const size_t count = std::min<size_t>(order.size(), NearestNodes::kCount);
  std::partial_sort(order.begin(), order.begin() + static_cast<ptrdiff_t>(count), order.end());
  const double sigma = kSigmaOfSpacing * spacing_m_;
  NearestNodes near;
  double sum = 0;
  for (size_t i = 0; i < count; ++i) {
    near.node[i] = order[i].second;
    near.weight[i] = std::exp((order[0].first - order[i].first) / (2 * sigma * sigma));
    sum += near.weight[i];
  }
  for (double& weight : near.weight) weight /= sum;
  return near;
}

}  // namespace bodyloom
