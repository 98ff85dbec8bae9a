// SPDX-License-Identifier: Apache-2.0
/// Scores of rendered people against true ones.
#pragma once

#include <memory>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/networks/named_weights.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// "Foreground" is the true one, labels other than the background. LPIPS and CS are of the whole window with a black
/// background. Without trained weights random features measure: they order results but compare with nobody else's
/// figures. LPIPS' are those of all renderers (neural/metrics/lpips.h); CS' are of a quarter of VGG-19's channels, for
/// speed.
struct GuidedScores {
  static constexpr int kLargestContextualPicture = 256;
  int frames = 0;
  double image_l1 = 0;        ///< mean |I − I_true| over foreground and channels
  double psnr_db = 0;         ///< over the foreground, range 1
  double silhouette_iou = 0;  ///< alpha at least ½
  double label_iou = 0;       ///< mean over the classes other than the background that occur; NaN: no labels are drawn
  double lpips = 0;           ///< mean over frames; NaN where not requested
  /// The paper's temporal stability: the standard deviation of LPIPS over a person's frames, pooled over people,
  /// sqrt(Σ_p Σ_f (d_pf − mean_p)² / frames).
  double lpips_deviation = 0;
  std::vector<std::vector<double>> lpips_of_people;  ///< of each person's frames, as they were added: the paper's curve
  /// Σ −log CX, mean over frames; NaN where not requested, and of pictures larger than kLargestContextualPicture: its
  /// time rises with the fourth power of their side.
  double contextual = 0;
  bool lpips_random_features = true, contextual_random_features = true;
};

/// Trained weights for LPIPS (alexnet and lpips_heads) and CS (vgg19); what is empty is measured by random features.
struct GuidedScoreWeights {
  WeightsFrom alexnet, lpips_heads, vgg19;
};

class GuidedScorer {
 public:
  /// `features`: with LPIPS and CS, which take their time. Throws std::runtime_error naming weights that do not fit.
  explicit GuidedScorer(bool features, const GuidedScoreWeights& weights = {});
  ~GuidedScorer();
  GuidedScorer(const GuidedScorer&) = delete;
  GuidedScorer& operator=(const GuidedScorer&) = delete;

  /// `truth` has a picture of the same size; std::invalid_argument otherwise.
  void Add(const GuidedPicture& picture, const PhotoFrame& truth);
  /// The frames that follow are of another person.
  void NextPerson();
  [[nodiscard]] GuidedScores Scores() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
