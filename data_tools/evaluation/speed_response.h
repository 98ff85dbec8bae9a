// SPDX-License-Identifier: Apache-2.0
/// Response of rendered clothes to the speed of the body: the same poses at two speeds, in truth and result.
///
/// Two single-person datasets show the same poses at two speeds (`synth-person --speed`), two results are a renderer's
/// output for them (`animate motion --set`, `animate avatar --set`). Frames are paired by pose. For each pair, the
/// change of one garment's image between the speeds is compared with the true change: it is zero for a renderer that
/// depends on the pose alone (slope 0) and equal to it for an ideal one that depends on the motion (correlation and
/// slope 1).
#pragma once

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Extent of a label's pixels in an image, in metres at the pelvis' depth, measured from the projected pelvis.
struct LabelExtent {
  static constexpr std::array<const char*, 4> kNames = {"left_m", "right_m", "bottom_m", "area_m2"};
  /// The 3rd and 97th percentile of its columns, the 97th of its rows (down), its area. NaN with fewer than 20 pixels.
  std::array<double, 4> values;
};

/// `labels` (a label's index in all channels) shows frame t of the track. Throws std::invalid_argument when the pelvis
/// is not in front of the camera.
LabelExtent MeasureLabelExtent(const Image& labels, PersonLabel label, const Track& track, int t);

/// Pairs (frame of a, frame of b), in order: poses equal to 1e-3 rad, positions to 1 cm. The first `frames_after_gap`
/// (≥ 0) frames of each gap-free run (geometry/uv_maps/velocity_stencil.h) are left out, as they lack a past at their
/// speed.
std::vector<std::pair<int, int>> PairFramesByPose(const Track& a, const Track& b, int frames_after_gap);

struct SpeedResponse {
  struct OfExtent {
    double truth_std = 0, result_std = 0;  ///< of the change between the speeds, over the pairs
    double correlation = std::numeric_limits<double>::quiet_NaN();  ///< of the two changes; NaN: one is constant
    double slope = std::numeric_limits<double>::quiet_NaN();        ///< Σ truth·result / Σ truth²
  };
  PersonLabel label = PersonLabel::kBottom;
  int pairs = 0;  ///< with the label in all four images
  std::array<OfExtent, 4> extents;
  double truth_iou = 0, result_iou = 0;  ///< of the label between the two speeds, mean over the pairs

  /// A quarter of the pairs, sorted by the difference of the truth's label between the two speeds (its IoU); equal
  /// pairs stay in order. Renderers that depend on the motion should be better where the difference is large.
  struct Quarter {
    int pairs = 0;
    double between_speeds = 0;      ///< mean IoU of the truth at one speed with the truth at the other
    double iou = 0, other_iou = 0;  ///< mean IoU of each result with its truth
  };
  std::array<Quarter, 4> quarters;  ///< from least to most different; sizes differ by one at most
};

/// Takes truths and results at two speeds; each result has the frames of its truth. Throws std::runtime_error naming a
/// set that lacks labels, has another number of frames or another size, or when no frame shows the same pose.
SpeedResponse MeasureSpeedResponse(const SinglePersonDataset& truth, const SinglePersonDataset& result,
                                   const SinglePersonDataset& other_truth, const SinglePersonDataset& other_result,
                                   PersonLabel label, int num_threads);

}  // namespace bodyloom
