// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_scores.h"

#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "neural/base/image_tensor.h"

namespace bodyloom {
namespace {

Image ImageOf(const std::vector<float>& planar, int size) {
  return ToImage(torch::from_blob(const_cast<float*>(planar.data()), {3, size, size}));
}

}  // namespace

void PhotoScorer::Add(const PhotoPicture& result, const PhotoFrame& truth) {
  const size_t pixels = static_cast<size_t>(truth.size) * truth.size;
  BODYLOOM_CHECK(result.size == truth.size && result.image.size() == 3 * pixels && result.alpha.size() == pixels &&
                     truth.image.size() == 3 * pixels,
                 "photo scores: a picture of ", result.size, " pixels a side against one of ", truth.size);
  for (size_t i = 0; i < pixels; ++i) {
    const bool shown = truth.labels.empty()
                           ? truth.image[i] > 0 || truth.image[pixels + i] > 0 || truth.image[2 * pixels + i] > 0
                           : truth.labels[i] != 0;
    silhouette_.Add(result.alpha[i] > 0.5F ? 1 : 0, shown ? 1 : 0);
    if (!shown) continue;
    for (size_t c = 0; c < 3; ++c) {
      const double error = double{result.image[c * pixels + i]} - truth.image[c * pixels + i];
      l1_ += std::abs(error);
      squared_ += error * error;
      ++values_;
    }
  }
  const Image picture = ImageOf(result.image, result.size), true_picture = ImageOf(truth.image, truth.size);
  if (ssim_) ssim_sum_ += ssim_(true_picture, picture);
  const LpipsValue lpips = lpips_.Distance(true_picture, picture);
  lpips_sum_ += lpips.value;
  random_features_ = lpips.random_features;
  ++pictures_;
}

PhotoScores PhotoScorer::Scores() const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto mean = [](double sum, double count) { return count > 0 ? sum / count : kNone; };
  PhotoScores scores;
  scores.pictures = pictures_;
  scores.image_l1 = mean(l1_, values_);
  scores.psnr_db = -10 * std::log10(mean(squared_, values_));
  scores.ssim = ssim_ ? mean(ssim_sum_, pictures_) : kNone;
  scores.lpips = mean(lpips_sum_, pictures_);
  scores.lpips_random_features = random_features_;
  scores.silhouette_iou = silhouette_.ForegroundIou();
  return scores;
}

}  // namespace bodyloom
