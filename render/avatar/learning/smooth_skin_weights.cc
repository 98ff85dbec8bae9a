// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/learning/smooth_skin_weights.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/geometry/posed_body.h"

namespace bodyloom {
namespace {

constexpr float kLeastSigma = 0.03F, kSigmaADistance = 0.7F;  ///< metres; of the distance to the body
constexpr int kVertexLanes = 16;
constexpr float kFarOff = 1e15F;
constexpr float kSigmas = 3;  ///< beyond so many σ a vertex counts nothing

}  // namespace

SmoothSkinWeights::SmoothSkinWeights(const BodyModel& model, const Eigen::VectorXd& betas, float reach, int num_threads)
    : vertices_(ShapeVertices(model, betas).cast<float>()), reach_(reach), num_joints_(model.num_joints()) {
  BODYLOOM_CHECK(reach >= 0.01F && reach <= 2, "smooth skin weights: reach is ", reach, " m, expected 0.01 to 2");
  for (int c = 0; c < 3; ++c) {
    // Whole lanes; those that stand in for a vertex are far off.
    columns_[c].assign((vertices_.rows() + kVertexLanes - 1) / kVertexLanes * kVertexLanes, kFarOff);
    for (Eigen::Index v = 0; v < vertices_.rows(); ++v) columns_[c][v] = vertices_(v, c);
  }
  low_ = vertices_.colwise().minCoeff().transpose().array() - reach - kCell;
  const Eigen::Vector3f most = vertices_.colwise().maxCoeff().transpose().array() + reach + kCell;
  for (int c = 0; c < 3; ++c) size_[c] = static_cast<int>(std::ceil((most[c] - low_[c]) / kCell)) + 1;
  const size_t nodes = static_cast<size_t>(size_[0]) * size_[1] * size_[2];
  distance_.assign(nodes, 2 * reach_ + 1);
  weights_.assign(nodes * num_joints_, 0.0F);
  const size_t slice = static_cast<size_t>(size_[0]) * size_[1];
  ParallelFor(size_[2], num_threads, [&](int z) {
    float at_least = 0;  // a distance changes by no more than a step
    for (size_t i = 0; i < slice; ++i) {
      at_least = i % size_[0] == 0 ? 0 : at_least - kCell;
      float& distance = distance_[z * slice + i];
      if (at_least > reach_ + 2 * kCell) {
        distance = at_least;
      } else {
        FillNode(model, z * slice + i);
        at_least = distance;
      }
    }
  });
}

Eigen::Vector3f SmoothSkinWeights::high() const {
  return low_ + kCell * (size_.cast<float>() - Eigen::Vector3f::Ones());
}

int SmoothSkinWeights::NearestVertex(const Eigen::Vector3f& place) const {
  int nearest = 0;
  float least = 1e30F;
  for (int v = 0; v < static_cast<int>(vertices_.rows()); ++v) {
    const float x = columns_[0][v] - place[0], y = columns_[1][v] - place[1], z = columns_[2][v] - place[2];
    const float square = x * x + y * y + z * z;
    if (square < least) least = square, nearest = v;
  }
  return nearest;
}

void SmoothSkinWeights::FillNode(const BodyModel& model, size_t node) {
  const auto x = static_cast<int>(node % size_[0]), y = static_cast<int>(node / size_[0] % size_[1]);
  const auto z = static_cast<int>(node / (static_cast<size_t>(size_[0]) * size_[1]));
  const Eigen::Vector3f place = low_ + kCell * Eigen::Vector3i(x, y, z).cast<float>();
  const auto count = static_cast<int>(vertices_.rows());
  thread_local std::vector<float> squares;
  squares.resize(columns_[0].size());
  float lanes[kVertexLanes];
  std::fill_n(lanes, kVertexLanes, kFarOff);
  for (size_t v = 0; v < squares.size(); v += kVertexLanes) {
    for (int k = 0; k < kVertexLanes; ++k) {
      const float dx = columns_[0][v + k] - place[0], dy = columns_[1][v + k] - place[1];
      const float dz = columns_[2][v + k] - place[2], square = dx * dx + dy * dy + dz * dz;
      squares[v + k] = square;
      lanes[k] = square < lanes[k] ? square : lanes[k];
    }
  }
  const float least = *std::min_element(lanes, lanes + kVertexLanes);
  const float distance = std::sqrt(least);
  distance_[node] = distance;
  if (distance > reach_ + 2 * kCell) return;
  const float sigma = std::max(kLeastSigma, kSigmaADistance * distance);
  const float farthest = (distance + kSigmas * sigma) * (distance + kSigmas * sigma);
  float* weights = weights_.data() + node * num_joints_;
  double total = 0;
  for (int v = 0; v < count; ++v) {
    if (squares[v] > farthest) continue;
    // Relative to the nearest one: far off all would round to nothing.
    const float share = std::exp((least - squares[v]) / (2 * sigma * sigma));
    total += share;
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      weights[model.influence_joint()[k]] += share * static_cast<float>(model.influence_weight()[k]);
    }
  }
  for (int j = 0; j < num_joints_; ++j) weights[j] = static_cast<float>(weights[j] / total);
}

void SmoothSkinWeights::CornersAt(const Eigen::Vector3f& place, Corner* corners) const {
  int first[3];
  float share[3];
  for (int c = 0; c < 3; ++c) {
    const float at = std::clamp((place[c] - low_[c]) / kCell, 0.0F, static_cast<float>(size_[c] - 1));
    first[c] = std::min(static_cast<int>(at), size_[c] - 2);
    share[c] = at - static_cast<float>(first[c]);
  }
  for (int i = 0; i < 8; ++i) {
    const int dx = i & 1, dy = i >> 1 & 1, dz = i >> 2;
    corners[i].index = (static_cast<size_t>(first[2] + dz) * size_[1] + first[1] + dy) * size_[0] + first[0] + dx;
    corners[i].share =
        (dx != 0 ? share[0] : 1 - share[0]) * (dy != 0 ? share[1] : 1 - share[1]) * (dz != 0 ? share[2] : 1 - share[2]);
  }
}

float SmoothSkinWeights::DistanceTo(const Eigen::Vector3f& place) const {
  for (int c = 0; c < 3; ++c) {
    if (place[c] < low_[c] || place[c] > high()[c]) return 2 * reach_ + 1;
  }
  Corner corners[8];
  CornersAt(place, corners);
  float sum = 0;
  for (const Corner& corner : corners) sum += corner.share * distance_[corner.index];
  return sum;
}

void SmoothSkinWeights::WeightsAt(const Eigen::Vector3f& place, float* weights) const {
  Corner corners[8];
  CornersAt(place, corners);
  std::fill_n(weights, num_joints_, 0.0F);
  for (const Corner& corner : corners) {
    for (int j = 0; j < num_joints_; ++j) weights[j] += corner.share * weights_[corner.index * num_joints_ + j];
  }
  float sum = 0;
  for (int j = 0; j < num_joints_; ++j) sum += weights[j];
  for (int j = 0; j < num_joints_; ++j) weights[j] /= std::max(1e-9F, sum);
}

}  // namespace bodyloom
