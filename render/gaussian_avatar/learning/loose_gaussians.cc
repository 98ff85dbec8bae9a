// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/loose_gaussians.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "render/gaussian_avatar/gaussian_body.h"

namespace bodyloom {
namespace {

using Eigen::Vector3f;

constexpr float kCorrectiveReach = 0.06F;  ///< distance where the corrective ends, metres

struct LoosePlace {
  Vector3f place;
  int32_t joints[GaussianBody::kInfluences];
  float weights[GaussianBody::kInfluences];
};

/// Keeps the six largest weights, with the pelvis in place of the last if it is not among them.
void KeepLargest(const std::vector<float>& weights, LoosePlace* place) {
  constexpr int kKept = GaussianBody::kInfluences;
  std::vector<int> order(weights.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return weights[a] > weights[b]; });
  order.resize(kKept, 0);
  if (std::find(order.begin(), order.end(), 0) == order.end()) order.back() = 0;
  for (int k = 0; k < kKept; ++k) {
    const bool again = std::find(order.begin(), order.begin() + k, order[k]) != order.begin() + k;
    place->joints[k] = order[k];
    place->weights[k] = std::max(1e-4F, again ? 0 : weights[order[k]]);
  }
  const float sum = std::accumulate(place->weights, place->weights + kKept, 0.0F);
  for (float& w : place->weights) w /= sum;
}

/// True if the share of views that show the person at a point is within the limits.
bool IsInShell(const LoosePlace& place, std::span<const TrainingView* const> views,
               const LooseGaussiansOptions& options) {
  const auto count = static_cast<float>(views.size());
  int inside = 0, outside = 0;
  for (const TrainingView* view : views) {
    Vector3f posed = Vector3f::Zero();
    for (int k = 0; k < GaussianBody::kInfluences; ++k) {
      const float* bone = view->frame.bones.data() + 12 * static_cast<size_t>(place.joints[k]);
      for (int r = 0; r < 3; ++r) {
        posed[r] += place.weights[k] * (bone[4 * r] * place.place[0] + bone[4 * r + 1] * place.place[1] +
                                        bone[4 * r + 2] * place.place[2] + bone[4 * r + 3]);
      }
    }
    Eigen::Vector2d pixel;
    if (!view->camera.Project(posed.cast<double>(), &pixel)) continue;
    if (!(pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < view->camera.width - 0.5 &&
          pixel.y() < view->camera.height - 0.5)) {
      continue;
    }
    const int x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
    if (view->ShowsPerson(x, y)) {
      ++inside;
    } else if (static_cast<float>(++outside) > (1 - options.min_share) * count) {
      return false;
    }
  }
  const auto seen = static_cast<float>(inside + outside);
  return inside > 0 && static_cast<float>(inside) >= options.min_share * seen &&
         static_cast<float>(inside) <= options.max_share * seen;
}

std::vector<const TrainingView*> SpreadViews(std::span<const TrainingView> views, int maximum) {
  std::vector<const TrainingView*> all, spread;
  for (const TrainingView& view : views) {
    if (!view.window.empty()) all.push_back(&view);
  }
  const size_t count = std::min<size_t>(all.size(), maximum);
  for (size_t i = 0; i < count; ++i) spread.push_back(all[i * all.size() / count]);
  return spread;
}

void SetRow(const SmoothSkinWeights& skin, const VertexAnchors& anchors, const LoosePlace& place,
            const LooseGaussiansOptions& options, int row, GaussianBody* body) {
  const int nearest = skin.NearestVertex(place.place);
  const Vector3f away = place.place - skin.vertices().row(nearest).transpose();
  const float distance = away.norm();
  const Vector3f normal = distance > 1e-6F ? Vector3f(away / distance) : Vector3f::UnitZ();
  FloatColumns& p = body->parameters;
  p(row, GaussianBody::kQuaternion) = 1;
  p(row, GaussianBody::kOpacityLogit) = options.opacity_logit;
  for (int k = 0; k < 3; ++k) {
    p(row, GaussianBody::kPosition + k) = place.place[k];
    p(row, GaussianBody::kLogScale + k) = std::log(options.spacing_m / 2);
    p(row, GaussianBody::kAlbedo + k) = options.albedo;
    p(row, GaussianBody::kNormal + k) = normal[k];
  }
  for (int k = 0; k < GaussianBody::kInfluences; ++k) {
    body->joints[static_cast<size_t>(row) * GaussianBody::kInfluences + k] = place.joints[k];
    p(row, GaussianBody::kWeightLogit + k) = std::log(place.weights[k]);
  }
  body->anchors[row] = anchors.At(nearest, std::max(0.0F, 1 - distance / kCorrectiveReach));
  body->kinds[row] = GaussianKind::kLoose;
}

}  // namespace

bool LooseGaussiansOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("spacing_m", spacing_m, 0.004, 0.1) && in_range("reach_m", reach_m, 0.02, 1) &&
         in_range("min_share", min_share, 0, 1) && in_range("max_share", max_share, min_share, 1) &&
         in_range("max_views", max_views, 1, 1e6) && in_range("count", count, 0, 1e7) &&
         in_range("opacity_logit", opacity_logit, -20, 20) && in_range("albedo", albedo, 0, 1) &&
         in_range("num_threads", num_threads, 1, 1024);
}

GaussianBody LooseGaussians(const BodyModel& model, const Eigen::VectorXd& betas, std::span<const TrainingView> views,
                            const LooseGaussiansOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "loose Gaussians: ", why);
  GaussianBody body;
  body.Resize(0);
  const std::vector<const TrainingView*> shown = SpreadViews(views, options.max_views);
  if (shown.empty() || options.count == 0) return body;
  const SmoothSkinWeights skin(model, betas, options.reach_m, options.num_threads);
  // Grid points around the person at rest, layer by layer.
  const Vector3f extent = skin.high() - skin.low();
  const Eigen::Vector3i size = (extent / options.spacing_m).array().floor().cast<int>() + 1;
  std::vector<std::vector<LoosePlace>> layers(size.z());
  ParallelFor(size.z(), options.num_threads, [&](int z) {
    std::vector<float> weights(skin.num_joints());
    for (int y = 0; y < size.y(); ++y) {
      for (int x = 0; x < size.x(); ++x) {
        LoosePlace place;
        place.place = skin.low() + options.spacing_m * Eigen::Vector3i(x, y, z).cast<float>();
        if (place.place.y() > options.covered_from_m && place.place.y() < options.covered_to_m) continue;
        if (skin.DistanceTo(place.place) > options.reach_m) continue;
        skin.WeightsAt(place.place, weights.data());
        KeepLargest(weights, &place);
        if (IsInShell(place, shown, options)) layers[z].push_back(place);
      }
    }
  });
  std::vector<LoosePlace> places;
  for (const auto& layer : layers) places.insert(places.end(), layer.begin(), layer.end());
  // A random subset of `count`, in grid order.
  if (places.size() > static_cast<size_t>(options.count)) {
    std::vector<std::pair<uint64_t, size_t>> drawn(places.size());
    for (size_t i = 0; i < places.size(); ++i) drawn[i] = {HashRandom(options.seed, {0x100, i}).Next(), i};
    std::nth_element(drawn.begin(), drawn.begin() + options.count, drawn.end());
    drawn.resize(options.count);
    std::sort(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    std::vector<LoosePlace> kept;
    kept.reserve(drawn.size());
    for (const auto& [hash, i] : drawn) kept.push_back(places[i]);
    places = std::move(kept);
  }
  const VertexAnchors anchors(model);
  body.Resize(static_cast<int>(places.size()));
  ParallelFor(body.size(), options.num_threads, [&](int i) { SetRow(skin, anchors, places[i], options, i, &body); });
  return body;
}

void AppendGaussians(const GaussianBody& more, GaussianBody* body) {
  GaussianBody both;
  both.Resize(body->size() + more.size());
  for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
    std::copy_n(body->parameters.column(c), body->size(), both.parameters.column(c));
    std::copy_n(more.parameters.column(c), more.size(), both.parameters.column(c) + body->size());
  }
  const auto join = [](const auto& a, const auto& b, auto* to) {
    std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), to->begin()));
  };
  join(body->joints, more.joints, &both.joints);
  join(body->anchors, more.anchors, &both.anchors);
  join(body->kinds, more.kinds, &both.kinds);
  both.light = body->light;
  *body = std::move(both);
}

namespace {

constexpr float kMinSigma = 0.03F, kSigmaADistance = 0.7F;  ///< minimum, metres; factor of the distance to the body
constexpr int kVertexLanes = 16;
constexpr float kFarOff = 1e15F;
constexpr float kSigmas = 3;  ///< vertices beyond so many σ are ignored

}  // namespace

SmoothSkinWeights::SmoothSkinWeights(const BodyModel& model, const Eigen::VectorXd& betas, float reach, int num_threads)
    : vertices_(ShapeVertices(model, betas).cast<float>()), reach_(reach), num_joints_(model.num_joints()) {
  BODYLOOM_CHECK(reach >= 0.01F && reach <= 2, "smooth skin weights: reach is ", reach, " m, expected 0.01 to 2");
  for (int c = 0; c < 3; ++c) {
    // Padded to whole lanes with far-away vertices.
    columns_[c].assign((vertices_.rows() + kVertexLanes - 1) / kVertexLanes * kVertexLanes, kFarOff);
    for (Eigen::Index v = 0; v < vertices_.rows(); ++v) columns_[c][v] = vertices_(v, c);
  }
  low_ = vertices_.colwise().minCoeff().transpose().array() - reach - kCell;
  const Eigen::Vector3f maximum = vertices_.colwise().maxCoeff().transpose().array() + reach + kCell;
  for (int c = 0; c < 3; ++c) size_[c] = static_cast<int>(std::ceil((maximum[c] - low_[c]) / kCell)) + 1;
  const size_t nodes = static_cast<size_t>(size_[0]) * size_[1] * size_[2];
  distance_.assign(nodes, 2 * reach_ + 1);
  weights_.assign(nodes * num_joints_, 0.0F);
  const size_t slice = static_cast<size_t>(size_[0]) * size_[1];
  ParallelFor(size_[2], num_threads, [&](int z) {
    float at_least = 0;  // lower bound: a distance changes by at most one step
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
  float minimum = 1e30F;
  for (int v = 0; v < static_cast<int>(vertices_.rows()); ++v) {
    const float x = columns_[0][v] - place[0], y = columns_[1][v] - place[1], z = columns_[2][v] - place[2];
    const float square = x * x + y * y + z * z;
    if (square < minimum) minimum = square, nearest = v;
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
  const float minimum = *std::min_element(lanes, lanes + kVertexLanes);
  const float distance = std::sqrt(minimum);
  distance_[node] = distance;
  if (distance > reach_ + 2 * kCell) return;
  const float sigma = std::max(kMinSigma, kSigmaADistance * distance);
  const float farthest = (distance + kSigmas * sigma) * (distance + kSigmas * sigma);
  float* weights = weights_.data() + node * num_joints_;
  double total = 0;
  for (int v = 0; v < count; ++v) {
    if (squares[v] > farthest) continue;
    // Relative to the nearest vertex, as all would underflow far from the body.
    const float share = std::exp((minimum - squares[v]) / (2 * sigma * sigma));
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
