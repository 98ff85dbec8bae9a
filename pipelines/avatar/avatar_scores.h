// SPDX-License-Identifier: Apache-2.0
/// How like the truth pictures of a person of Gaussians are.
#pragma once

#include <string>

#include "bodyloom/render/avatar/learning/training_view.h"
#include "bodyloom/render/splat/splat_picture.h"

namespace bodyloom {

/// Means over frames. Pictures are compared in bytes, both over black, in the box around the true person that the
/// views have (kScoreMargin pixels wide).
struct AvatarScores {
  static constexpr int kScoreMargin = 32;
  int frames = 0;
  double psnr_box_db = 0;
  double psnr_person_db = 0;  ///< of the pixels of the true person
  double ssim = 0;            ///< of the box, preset 3dgs (data_tools/evaluation/ssim.h)
  double l1 = 0;              ///< of the box, in [0, 1]
  double outline_iou = 0;     ///< of the true person and where alpha is at least ½
};

/// Collects them.
class AvatarScorer {
 public:
  /// `picture`: drawn in the view's window.
  void Add(const TrainingView& view, const SplatPicture& picture);
  [[nodiscard]] AvatarScores Means() const;

 private:
  AvatarScores sums_;
};

/// The person over black; of the truth, and of a picture drawn in the view's window.
Image TrueWindow(const TrainingView& view);
Image DrawnWindow(const SplatPicture& picture);

/// "34 frames: PSNR 24.1 dB in the box, 20.4 dB in the person, …"
std::string ScoresText(const AvatarScores& scores);

}  // namespace bodyloom
