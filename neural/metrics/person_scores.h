// SPDX-License-Identifier: Apache-2.0
/// Scores of people rendered from photos against the true images.
#pragma once

#include <memory>
#include <vector>

#include "neural/base/rendered_person.h"
#include "neural/metrics/contextual_similarity.h"
#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/networks/named_weights.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

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
