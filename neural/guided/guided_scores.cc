// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_scores.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "geometry/base/check.h"
#include "neural/metrics/contextual_similarity.h"
#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"

namespace bodyloom {
namespace {

constexpr int kContextualRandomFeaturesDivisor = 4;

Image Bytes(const std::vector<float>& planar, int size) {
  Image image(size, size);
  const size_t pixels = size_t(size) * size;
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const float value = planar[(2 - c) * pixels + i];
      image.bgr[3 * i + c] = value > 0 ? static_cast<uint8_t>(std::lround(255 * std::min(1.0F, value))) : uint8_t{0};
    }
  }
  return image;
}

}  // namespace

struct GuidedScorer::Impl {
  std::optional<Lpips> lpips;
  std::optional<ContextualMetric> contextual;
  int frames = 0;
  double l1 = 0, squared = 0, foreground = 0;
  double contextual_sum = 0;
  std::vector<std::vector<double>> lpips_of_people;
  bool next_person = true;
  bool contextual_random_features = true;
  ClassOverlap overlap{kPhotoLabels};
};

GuidedScorer::GuidedScorer(bool features, const GuidedScoreWeights& weights) : impl_(std::make_unique<Impl>()) {
  if (!features) return;
  impl_->lpips.emplace(LpipsFrom(weights.alexnet, weights.lpips_heads));
  const bool trained = !weights.vgg19.empty();
  impl_->contextual.emplace(trained ? 1 : kContextualRandomFeaturesDivisor);
  if (trained) impl_->contextual->Load(weights.vgg19.weights, weights.vgg19.source);
}
GuidedScorer::~GuidedScorer() = default;

void GuidedScorer::Add(const GuidedPicture& picture, const PhotoFrame& truth) {
  const size_t pixels = picture.alpha.size();
  BODYLOOM_CHECK(picture.size == truth.size && truth.labels.size() == pixels && truth.image.size() == 3 * pixels,
                 "scores: a picture of ", picture.size, " px beside a truth of ", truth.size);
  Impl& s = *impl_;
  ++s.frames;
  for (size_t i = 0; i < pixels; ++i) {
    s.overlap.Add(size_t{picture.labels[i]}, size_t{truth.labels[i]});
    if (truth.labels[i] == 0) continue;
    s.foreground += 1;
    for (size_t c = 0; c < 3; ++c) {
      const double error = double(picture.image[c * pixels + i]) - truth.image[c * pixels + i];
      s.l1 += std::abs(error);
      s.squared += error * error;
    }
  }
  if (!s.lpips) return;
  const Image image = Bytes(picture.image, picture.size), true_image = Bytes(truth.image, truth.size);
  const double distance = s.lpips->Distance(image, true_image).value;
  if (std::exchange(s.next_person, false)) s.lpips_of_people.emplace_back();
  s.lpips_of_people.back().push_back(distance);
  if (picture.size > GuidedScores::kLargestContextualPicture) {
    s.contextual_sum = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const ContextualValue contextual = (*s.contextual)(image, true_image);
  s.contextual_sum += contextual.distance;
  s.contextual_random_features = contextual.random_features;
}

void GuidedScorer::NextPerson() { impl_->next_person = true; }

GuidedScores GuidedScorer::Scores() const {
  const Impl& s = *impl_;
  GuidedScores scores;
  scores.frames = s.frames;
  if (s.frames == 0) return scores;
  scores.image_l1 = s.l1 / std::max(1.0, 3 * s.foreground);
  scores.psnr_db = -10 * std::log10(std::max(1e-12, s.squared / std::max(1.0, 3 * s.foreground)));
  const auto or_zero = [](double iou) { return std::isnan(iou) ? 0 : iou; };
  scores.silhouette_iou = or_zero(s.overlap.ForegroundIou());
  scores.label_iou = or_zero(s.overlap.MeanIou(/*in_truth=*/true));
  const double n = s.frames, none = std::numeric_limits<double>::quiet_NaN();
  double sum = 0, around_means = 0;
  for (const std::vector<double>& person : s.lpips_of_people) {
    const double of_person = std::accumulate(person.begin(), person.end(), 0.0);
    const double mean = of_person / static_cast<double>(person.size());
    sum += of_person;
    for (const double distance : person) around_means += (distance - mean) * (distance - mean);
  }
  scores.lpips = s.lpips ? sum / n : none;
  scores.lpips_deviation = s.lpips ? std::sqrt(around_means / n) : none;
  scores.lpips_of_people = s.lpips_of_people;
  scores.lpips_random_features = !s.lpips || s.lpips->has_random_features();
  scores.contextual_random_features = s.contextual_random_features;
  scores.contextual = s.contextual ? s.contextual_sum / n : none;
  return scores;
}

}  // namespace bodyloom
