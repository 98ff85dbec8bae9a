// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/relocate_gaussians.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

constexpr float kCopySize = 0.8F;

float OpacityAt(const GaussianBody& body, int row) {
  return 1 / (1 + std::exp(-body.parameters(row, GaussianBody::kOpacityLogit)));
}

/// Offset from a Gaussian's mean, in rest space, sampled from its distribution.
Eigen::Vector3f DrawnOffset(const GaussianBody& body, int row, HashRandom* random) {
  const FloatColumns& p = body.parameters;
  Eigen::Quaternionf turn(p(row, GaussianBody::kQuaternion), p(row, GaussianBody::kQuaternion + 1),
                          p(row, GaussianBody::kQuaternion + 2), p(row, GaussianBody::kQuaternion + 3));
  if (turn.norm() < 1e-6F) turn = Eigen::Quaternionf::Identity();
  Eigen::Vector3f along;
  for (int k = 0; k < 3; ++k) {
    along[k] = static_cast<float>(random->Normal()) * std::exp(p(row, GaussianBody::kLogScale + k));
  }
  return turn.normalized() * along;
}

void CopyRow(int from, int to, GaussianBody* body) {
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) body->parameters(to, c) = body->parameters(from, c);
  std::copy_n(body->joints.begin() + static_cast<int64_t>(from) * GaussianBody::kInfluences, GaussianBody::kInfluences,
              body->joints.begin() + static_cast<int64_t>(to) * GaussianBody::kInfluences);
  body->anchors[to] = body->anchors[from];
  body->kinds[to] = body->kinds[from];
}

}  // namespace

std::vector<int> RelocateGaussians(std::span<const float> pull, const RelocateOptions& options, GaussianBody* body) {
  const int count = body->size();
  BODYLOOM_CHECK(static_cast<int>(pull.size()) == count, "moving Gaussians: ", pull.size(), " pulls for ", count,
                 " rows");
  std::vector<double> until(count);
  std::vector<int> dead;
  double total = 0;
  for (int i = 0; i < count; ++i) {
    const bool lives = OpacityAt(*body, i) >= options.dead_opacity;
    if (lives && std::isfinite(pull[i]) && pull[i] > 0) total += pull[i];
    if (!lives) dead.push_back(i);
    until[i] = total;
  }
  if (!(total > 0)) return {};
  for (const int row : dead) {
    HashRandom random(options.seed, {0x200, static_cast<uint64_t>(row)});
    const double drawn = total * random.Uniform();
    const auto from = static_cast<int>(std::upper_bound(until.begin(), until.end(), drawn) - until.begin());
    if (from >= count) continue;
    const float opacity = std::min(0.999F, OpacityAt(*body, from)), halved = 1 - std::sqrt(1 - opacity);
    body->parameters(from, GaussianBody::kOpacityLogit) = std::log(halved / (1 - halved));
    for (int k = 0; k < 3; ++k) body->parameters(from, GaussianBody::kLogScale + k) += std::log(kCopySize);
    const Eigen::Vector3f offset = DrawnOffset(*body, from, &random);
    CopyRow(from, row, body);
    for (int k = 0; k < 3; ++k) body->parameters(row, GaussianBody::kPosition + k) += offset[k];
  }
  return dead;
}

}  // namespace bodyloom
