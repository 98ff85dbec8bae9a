// SPDX-License-Identifier: Apache-2.0
/// A trained motion-dependent renderer against pictures of the person it was trained on.
#pragma once

#include <limits>
#include <vector>

namespace bodyloom {

/// Means over frames of roll-outs, one a stretch, that begin with nothing. "Foreground" is the true one: labels other
/// than the background.
struct MotionScores {
  double image_l1 = 0;            ///< mean |Â − A| over the foreground and channels
  double psnr_db = 0;             ///< over the foreground, range 1
  double label_iou = 0;           ///< mean over the classes other than the background that occur; NaN without labels
  double foreground_iou = 0;      ///< NaN without labels
  std::vector<double> class_iou;  ///< by class; NaN where it does not occur; empty without labels
  double normal_deg = 0;          ///< mean angle over the foreground; NaN without normals
  double flicker = 0;  ///< mean over the foreground of |(Â_t − Â_{t−1}) − (A_t − A_{t−1})|: errors that move
  // Of whole windows, both on black; NaN where not measured (window too small, or not requested). Between frames the
  // window of the one before is laid where it was, as for flicker.
  double ssim = 0, lpips = 0, tlpips = 0;
  bool lpips_random_features = true;  ///< LPIPS and tLPIPS compare with nobody else's figures
  int frames = 0;
};

/// The same of one frame.
struct MotionFrameScores {
  double image_l1 = std::numeric_limits<double>::quiet_NaN(), ssim = image_l1, lpips = image_l1;
  double tlpips = image_l1;  ///< NaN for a clip's first frame
};

}  // namespace bodyloom
