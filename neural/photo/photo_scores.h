// SPDX-License-Identifier: Apache-2.0
/// Scores of rendered pictures against true ones.
#pragma once

#include <utility>

#include "neural/metrics/lpips.h"
#include "neural/metrics/pixel_metrics.h"
#include "neural/photo/photo_picture.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Means over pictures. "Foreground" is the true one: labels other than the background, else what is not black.
struct PhotoScores {
  int pictures = 0;
  double image_l1 = 0;                ///< mean |I − Î| over foreground and channels
  double psnr_db = 0;                 ///< of the mean square over all pictures' foregrounds, range 1
  double ssim = 0;                    ///< as the caller's function says, on whole frames; NaN without one
  double lpips = 0;                   ///< on whole frames, black background
  bool lpips_random_features = true;  ///< not comparable with other programs' figures
  double silhouette_iou = 0;          ///< of alpha > ½ and the true foreground
};

class PhotoScorer {
 public:
  /// `lpips` must outlive this; `ssim` may be empty.
  PhotoScorer(const Lpips& lpips, PictureSimilarity ssim) : lpips_(lpips), ssim_(std::move(ssim)) {}
  /// Throws std::invalid_argument when sizes differ or the truth has no picture.
  void Add(const PhotoPicture& result, const PhotoFrame& truth);
  /// All NaN but `pictures` when there was none.
  [[nodiscard]] PhotoScores Scores() const;

 private:
  const Lpips& lpips_;
  PictureSimilarity ssim_;
  int pictures_ = 0;
  bool random_features_ = true;
  double l1_ = 0, squared_ = 0, values_ = 0, ssim_sum_ = 0, lpips_sum_ = 0;
  ClassOverlap silhouette_{2};
};

}  // namespace bodyloom
