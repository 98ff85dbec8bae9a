// SPDX-License-Identifier: Apache-2.0
/// A trained motion-dependent renderer against pictures of the person it was trained on.
#pragma once

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
  int frames = 0;
};

}  // namespace bodyloom
