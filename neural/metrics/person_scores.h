// SPDX-License-Identifier: Apache-2.0
/// Scores of people rendered from photos against the true images.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "neural/base/rendered_person.h"
#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/networks/named_weights.h"
#include "render/image/image.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

// CS: contextual similarity of an image to a target that need not be aligned with it
// (neural/losses/image_losses.h), preset of Men et al., CVPR 2020 (ADGAN): VGG-19, relu3_2 and relu4_2, RGB in [0,
// 1] without normalisation, h = 0.1, all positions, one pair at a time (the published program centres over a batch of
// up to 48 pairs).
//
// The published program uses the converted Caffe model of VGG (names "conv1_1.weight", …); torchvision's weights are
// accepted too, but give other values. It sums CX over the two layers (larger is better); tables with values above 2
// (Yoon et al., CVPR 2021) are presumably sums of −log CX (lower is better). Both are returned.

struct ContextualValue {
  double similarity = 0;        ///< Σ CX over the two layers, at most 2
  double distance = 0;          ///< Σ −log CX, at least 0
  bool random_features = true;  ///< not comparable with other programs' figures
};

class ContextualMetric {
 public:
  /// Starts as a random-feature substitute (with 1/divisor of the channels) until Load is called.
  explicit ContextualMetric(int random_features_divisor = 1, uint64_t random_features_seed = 1);
  ~ContextualMetric();
  ContextualMetric(ContextualMetric&&) noexcept;
  ContextualMetric& operator=(ContextualMetric&&) noexcept;

  /// Throws std::runtime_error naming source and tensor when one does not fit, std::invalid_argument for a divisor
  /// other than 1.
  void Load(const NamedWeights& vgg19, const std::string& source);

  /// Images of at least 8 pixels a side; the two may differ in size.
  [[nodiscard]] ContextualValue operator()(const Image& image, const Image& target) const;

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

/// "Foreground" is the true one: labels other than the background, or pixels that are not black for a truth without
/// labels. SSIM, LPIPS and CS are of the whole window with a black background; NaN: not requested. Without trained
/// weights random features are used: they rank results but are not comparable with published figures. LPIPS uses those
/// of all renderers (neural/metrics/lpips.h); CS a quarter of VGG-19's channels, for speed.
struct PersonScores {
  static constexpr int kLargestContextualImage = 256;
  int frames = 0;
  double image_l1 = 0;        ///< mean |I − I_true| over foreground and channels; NaN without foreground
  double psnr_db = 0;         ///< from the mean squared error over all foregrounds, range 1, at most 120
  double ssim = 0;            ///< by the caller's function, mean over frames
  double silhouette_iou = 0;  ///< of labels other than the background, or of alpha ≥ ½ without labels
  double label_iou = 0;       ///< mean over the classes other than the background that occur; NaN: no labels
  double lpips = 0;           ///< mean over frames
  /// The paper's temporal stability: the standard deviation of LPIPS over a person's frames, pooled over people,
  /// sqrt(Σ_p Σ_f (d_pf − mean_p)² / frames) (Yoon et al., CVPR 2021).
  double lpips_deviation = 0;
  std::vector<std::vector<double>> lpips_of_people;  ///< of each person's frames, in the order added: the paper's curve
  /// Σ −log CX, mean over frames; NaN also for images larger than kLargestContextualImage, as its time grows with the
  /// fourth power of their side.
  double contextual = 0;
  bool lpips_random_features = true, contextual_random_features = true;
};

/// Metrics to compute besides colours and outlines; absent: not computed.
struct PersonScoring {
  std::shared_ptr<const Lpips> lpips = nullptr;
  std::shared_ptr<const ContextualMetric> contextual = nullptr;
  ImageSimilarity ssim = {};
};

/// Trained weights for LPIPS (alexnet and lpips_heads) and CS (vgg19); random features are used for empty ones.
struct LikenessWeights {
  WeightsFrom alexnet, lpips_heads, vgg19;
};

/// Scoring with LPIPS and CS, which are slow. Throws std::runtime_error naming weights that do not fit.
PersonScoring LikenessScoring(const LikenessWeights& weights = {}, ImageSimilarity ssim = {});

class PersonScorer {
 public:
  explicit PersonScorer(PersonScoring scoring = {});

  /// Adds a frame. `truth` has an image of the same size; std::invalid_argument otherwise.
  void Add(const RenderedPerson& rendered, const PhotoFrame& truth);
  /// Declares that the following frames are of another person.
  void NextPerson() { next_person_ = true; }
  /// Scores of all frames added; zero without a frame.
  [[nodiscard]] PersonScores Scores() const;

 private:
  void AddLikeness(const RenderedPerson& rendered, const PhotoFrame& truth);

  PersonScoring scoring_;
  int frames_ = 0;
  double l1_ = 0, squared_ = 0, values_ = 0, ssim_ = 0, contextual_ = 0;
  bool next_person_ = true, draws_labels_ = true, contextual_random_features_ = true;
  std::vector<std::vector<double>> lpips_of_people_;
  ClassOverlap overlap_{kPhotoLabels};
};

}  // namespace bodyloom
