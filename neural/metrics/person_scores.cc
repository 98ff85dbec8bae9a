// SPDX-License-Identifier: Apache-2.0
#include "neural/metrics/person_scores.h"

#include <torch/torch.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/base/check.h"
#include "neural/base/image_tensor.h"
#include "neural/losses/image_losses.h"
#include "neural/networks/vgg.h"
#include "render/texture/planar_image.h"

namespace bodyloom {
namespace {

constexpr int kContextualRandomFeaturesDivisor = 4;
constexpr double kNotScored = std::numeric_limits<double>::quiet_NaN();

bool ShowsPerson(const PhotoFrame& truth, size_t pixel) {
  if (!truth.labels.empty()) return truth.labels[pixel] != 0;
  const size_t pixels = truth.image.size() / 3;
  return truth.image[pixel] > 0 || truth.image[pixels + pixel] > 0 || truth.image[2 * pixels + pixel] > 0;
}

}  // namespace

struct ContextualMetric::Network {
  FeatureNetwork vgg{nullptr};
};

ContextualMetric::ContextualMetric(int random_features_divisor, uint64_t random_features_seed)
    : network_(std::make_unique<Network>()) {
  FeatureNetworkOptions options;
  options.trunk = FeatureTrunk::kVgg19;
  options.taps = FeatureLayers(options.trunk, {"relu3_2", "relu4_2"});
  options.normalise = false;
  options.random_features_divisor = random_features_divisor;
  options.random_features_seed = random_features_seed;
  network_->vgg = FeatureNetwork(options);
}

ContextualMetric::~ContextualMetric() = default;
ContextualMetric::ContextualMetric(ContextualMetric&&) noexcept = default;
ContextualMetric& ContextualMetric::operator=(ContextualMetric&&) noexcept = default;

void ContextualMetric::Load(const NamedWeights& vgg19, const std::string& source) {
  network_->vgg->Load(vgg19, source);
}

ContextualValue ContextualMetric::operator()(const Image& image, const Image& target) const {
  const torch::NoGradGuard no_grad;
  const auto features = network_->vgg(ToTensor(image)), wanted = network_->vgg(ToTensor(target));
  ContextualOptions options;
  options.bandwidth = 0.1;
  options.max_points = 0;
  ContextualValue value;
  for (size_t i = 0; i < features.size(); ++i) {
    const double similarity = ContextualSimilarity(features[i], wanted[i], options)[0].item<double>();
    value.similarity += similarity;
    value.distance -= std::log(similarity);
  }
  value.random_features = network_->vgg->has_random_features;
  return value;
}

PersonScoring LikenessScoring(const LikenessWeights& weights, ImageSimilarity ssim) {
  const bool trained = !weights.vgg19.empty();
  const auto contextual = std::make_shared<ContextualMetric>(trained ? 1 : kContextualRandomFeaturesDivisor);
  if (trained) contextual->Load(weights.vgg19.weights, weights.vgg19.source);
  return {std::make_shared<const Lpips>(LpipsFrom(weights.alexnet, weights.lpips_heads)), contextual, std::move(ssim)};
}

PersonScorer::PersonScorer(PersonScoring scoring) : scoring_(std::move(scoring)) {}

void PersonScorer::Add(const RenderedPerson& rendered, const PhotoFrame& truth) {
  const size_t pixels = static_cast<size_t>(truth.size) * truth.size;
  const auto of_window = [&](size_t size) { return size == 0 || size == pixels; };
  BODYLOOM_CHECK(rendered.size == truth.size && rendered.image.size() == 3 * pixels &&
                     rendered.alpha.size() == pixels && of_window(rendered.labels.size()) &&
                     truth.image.size() == 3 * pixels && of_window(truth.labels.size()),
                 "scores: an image of ", rendered.size, " px beside a truth of ", truth.size);
  ++frames_;
  draws_labels_ = draws_labels_ && !rendered.labels.empty() && !truth.labels.empty();
  for (size_t i = 0; i < pixels; ++i) {
    const bool shown = ShowsPerson(truth, i);
    const size_t drawn = rendered.labels.empty() ? (rendered.alpha[i] >= 0.5F ? 1 : 0) : rendered.labels[i];
    overlap_.Add(drawn, truth.labels.empty() ? size_t{shown} : size_t{truth.labels[i]});
    if (!shown) continue;
    for (size_t c = 0; c < 3; ++c) {
      const double error = double{rendered.image[c * pixels + i]} - truth.image[c * pixels + i];
      l1_ += std::abs(error);
      squared_ += error * error;
    }
    values_ += 3;
  }
  if (scoring_.lpips || scoring_.contextual || scoring_.ssim) AddLikeness(rendered, truth);
}

void PersonScorer::AddLikeness(const RenderedPerson& rendered, const PhotoFrame& truth) {
  const int size = rendered.size;
  const Image image = ImageFromPlanes(rendered.image, size, size),
              true_image = ImageFromPlanes(truth.image, size, size);
  if (scoring_.ssim) ssim_ += scoring_.ssim(true_image, image);
  if (scoring_.lpips) {
    if (std::exchange(next_person_, false)) lpips_of_people_.emplace_back();
    lpips_of_people_.back().push_back(scoring_.lpips->Distance(image, true_image).value);
  }
  if (!scoring_.contextual) return;
  if (size > PersonScores::kLargestContextualImage) {
    contextual_ = kNotScored;
    return;
  }
  const ContextualValue contextual = (*scoring_.contextual)(image, true_image);
  contextual_ += contextual.distance;
  contextual_random_features_ = contextual.random_features;
}

PersonScores PersonScorer::Scores() const {
  PersonScores scores;
  scores.frames = frames_;
  if (frames_ == 0) return scores;
  const double n = frames_, none = kNotScored;
  const double mean_squared = values_ > 0 ? squared_ / values_ : none;
  scores.image_l1 = values_ > 0 ? l1_ / values_ : none;
  scores.psnr_db = values_ > 0 ? -10 * std::log10(std::max(1e-12, mean_squared)) : none;
  scores.ssim = scoring_.ssim ? ssim_ / n : none;
  const auto or_zero = [](double iou) { return std::isnan(iou) ? 0 : iou; };
  scores.silhouette_iou = or_zero(overlap_.ForegroundIou());
  scores.label_iou = draws_labels_ ? or_zero(overlap_.MeanIou(/*in_truth=*/true)) : none;
  double sum = 0, around_means = 0;
  for (const std::vector<double>& person : lpips_of_people_) {
    const double of_person = std::accumulate(person.begin(), person.end(), 0.0);
    const double mean = of_person / static_cast<double>(person.size());
    sum += of_person;
    for (const double distance : person) around_means += (distance - mean) * (distance - mean);
  }
  scores.lpips = scoring_.lpips ? sum / n : none;
  scores.lpips_deviation = scoring_.lpips ? std::sqrt(around_means / n) : none;
  scores.lpips_of_people = lpips_of_people_;
  scores.lpips_random_features = !scoring_.lpips || scoring_.lpips->has_random_features();
  scores.contextual_random_features = contextual_random_features_;
  scores.contextual = scoring_.contextual ? contextual_ / n : none;
  return scores;
}

}  // namespace bodyloom
