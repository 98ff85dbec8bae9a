// SPDX-License-Identifier: Apache-2.0
/// Computes LPIPS and tLPIPS of a video frame by frame; each frame's features are computed once.
///
/// tLPIPS of frame t = |LPIPS(s_t, s_{t−1}) − LPIPS(g_t, g_{t−1})| with result s and truth g: the difference between
/// the changes of result and truth. Windows that follow a person are aligned first (Shifted,
/// neural/base/image_tensor.h), so that a jump of the window is not a change. A video's value is the mean over its
/// frames except the first (of every cut). Tables print 100 times that. Source: Chu et al., "Learning Temporal
/// Coherence via Self-Supervision for GAN-based Video Generation", 2020 (which crops and drops two frames at each end;
/// this does not), as used by Yoon et al., CVPR 2022.
#pragma once

#include <optional>

#include "neural/metrics/lpips.h"

namespace bodyloom {

/// | d(s_t, s_{t−1}) − d(g_t, g_{t−1}) | from the four images' features, with the distance d of `lpips`.
double TemporalLpipsOf(const Lpips& lpips, const LpipsFeatures& result, const LpipsFeatures& result_before,
                       const LpipsFeatures& truth, const LpipsFeatures& truth_before);

struct TemporalLpipsMean {
  int frames = 0;
  double lpips = 0;   ///< mean over frames
  double tlpips = 0;  ///< mean over frames with a predecessor; 0 if there are none
  int pairs = 0;      ///< of them
  bool random_features = true;
};

class TemporalLpips {
 public:
  struct Frame {
    double lpips = 0;
    std::optional<double> tlpips;  ///< none for the first frame
    bool random_features = true;
  };

  /// `lpips` must outlive this.
  explicit TemporalLpips(const Lpips& lpips) : lpips_(lpips) {}

  /// Adds the next frame. The previous frame's images lie at (before_x, before_y) in the current ones; pixels outside
  /// them are black. Throws std::invalid_argument when the images differ in size, from each other or from the previous
  /// frame.
  Frame Add(const Image& result, const Image& truth, int before_x = 0, int before_y = 0);

  /// Starts a new sequence: the next frame has no tLPIPS.
  void Restart() { follows_ = false; }

  [[nodiscard]] TemporalLpipsMean Mean() const;

 private:
  /// A frame's image, for shifting, and its features without shift.
  struct Seen {
    Image image;
    LpipsFeatures features;
  };
  /// Features of an image shifted by (x, y).
  [[nodiscard]] LpipsFeatures Moved(const Seen& seen, int x, int y) const;

  const Lpips& lpips_;
  Seen last_result_, last_truth_;
  bool follows_ = false;
  int frames_ = 0, pairs_ = 0;
  double sum_lpips_ = 0, sum_tlpips_ = 0;
};

}  // namespace bodyloom
