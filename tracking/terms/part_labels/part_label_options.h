// SPDX-License-Identifier: Apache-2.0
/// Options of the silhouette and of the part labels.
#pragma once

namespace bodyloom {

/// Part labels and silhouettes (part_label_term.h).
struct PartLabelOptions {
  double silhouette_weight = 1;  ///< weight of the contour of all parts together; 0: off
  double part_weight = 1;        ///< weight of each part's contour and pixels; 0: off
  double sigma_share = 0.01;     ///< σ of a contour as a share of the person's height in the image
  /// The same where a mask (AsMask) reaches beyond the body, as clothes and hair do; less than sigma_share counts as
  /// sigma_share, for masks of bare bodies. Found on synthetic dressed people (docs/lab/pose_detector.md).
  double clothes_sigma_share = 0.03;
  double start_kernel = 16, kernel = 4;  ///< c of the robust kernel in σ, in the first and in the last round
  int rounds = 5;          ///< solves on the coarse frames; what corresponds to what is found again before each
  int max_iterations = 8;  ///< solver iterations of a round

  /// For clips whose 2D joints were read off the labels themselves: they add nothing to the labels but a start, and the
  /// labels are all there is against the priors. Weights 10 and 30, found on the first half of the real clip of
  /// docs/benchmarks.md (1, 3, 10, 30, 100 tried) and confirmed on its second half. Beside a detector's joints they
  /// are too much: shoulders and hips follow the clothes.
  static PartLabelOptions LabelsAlone() {
    PartLabelOptions options;
    options.silhouette_weight = 10;
    options.part_weight = 30;
    return options;
  }
};

}  // namespace bodyloom
