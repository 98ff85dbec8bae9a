// SPDX-License-Identifier: Apache-2.0
/// Scores of people as renderers drew them from photos, against the true pictures.
#pragma once

#include <memory>
#include <vector>

#include "neural/base/person_picture.h"
#include "neural/metrics/contextual_similarity.h"
#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/networks/named_weights.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// "Foreground" is the true one: labels other than the background, of a truth without labels what is not black. SSIM,
/// LPIPS and CS are of the whole window with a black background; NaN: not requested. Without trained weights random
/// features measure: they order results but compare with nobody else's figures. LPIPS' are those of all renderers
/// (neural/metrics/lpips.h); CS' are of a quarter of VGG-19's channels, for speed.
struct PersonScores {
  static constexpr int kLargestContextualPicture = 256;
  int frames = 0;
  double image_l1 = 0;        ///< mean |I − I_true| over foreground and channels; NaN without foreground
  double psnr_db = 0;         ///< of the mean square over all pictures' foregrounds, range 1, at most 120
  double ssim = 0;            ///< as the caller's function says, mean over frames
  double silhouette_iou = 0;  ///< labels other than the background, without labels alpha at least ½
  double label_iou = 0;       ///< mean over the classes other than the background that occur; NaN: no labels are drawn
  double lpips = 0;           ///< mean over frames
  /// The paper's temporal stability: the standard deviation of LPIPS over a person's frames, pooled over people,
  /// sqrt(Σ_p Σ_f (d_pf − mean_p)² / frames) (Yoon et al., CVPR 2021).
  double lpips_deviation = 0;
  std::vector<std::vector<double>> lpips_of_people;  ///< of each person's frames, as they were added: the paper's curve
  /// Σ −log CX, mean over frames; NaN too of pictures larger than kLargestContextualPicture: its time rises with the
  /// fourth power of their side.
  double contextual = 0;
  bool lpips_random_features = true, contextual_random_features = true;
};

/// What is measured beside colours and outlines; absent: it is not.
struct PersonScoring {
  std::shared_ptr<const Lpips> lpips = nullptr;
  std::shared_ptr<const ContextualMetric> contextual = nullptr;
  PictureSimilarity ssim = {};
};

/// Trained weights for LPIPS (alexnet and lpips_heads) and CS (vgg19); what is empty is measured by random features.
struct LikenessWeights {
  WeightsFrom alexnet, lpips_heads, vgg19;
};

/// With LPIPS and CS, which take their time. Throws std::runtime_error naming weights that do not fit.
PersonScoring LikenessScoring(const LikenessWeights& weights = {}, PictureSimilarity ssim = {});

class PersonScorer {
 public:
  explicit PersonScorer(PersonScoring scoring = {});

  /// `truth` has a picture of the same size; std::invalid_argument otherwise.
  void Add(const PersonPicture& picture, const PhotoFrame& truth);
  /// The frames that follow are of another person.
  void NextPerson() { next_person_ = true; }
  /// Zero without a frame.
  [[nodiscard]] PersonScores Scores() const;

 private:
  void AddLikeness(const PersonPicture& picture, const PhotoFrame& truth);

  PersonScoring scoring_;
  int frames_ = 0;
  double l1_ = 0, squared_ = 0, values_ = 0, ssim_ = 0, contextual_ = 0;
  bool next_person_ = true, draws_labels_ = true, contextual_random_features_ = true;
  std::vector<std::vector<double>> lpips_of_people_;
  ClassOverlap overlap_{kPhotoLabels};
};

}  // namespace bodyloom
