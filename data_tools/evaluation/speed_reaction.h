// SPDX-License-Identifier: Apache-2.0
/// Reaction of rendered clothes to the speed of the body: the same poses at two speeds, in truth and in the result.
///
/// Two single-person datasets show the same poses at another speed (`synth-person --speed`), two results show what a
/// renderer made of them (`animate motion --set`, `animate avatar --set`). Frames are paired by pose. Of each pair, how
/// one garment's picture changes from one speed to the other is compared with how it should: a renderer that knows the
/// pose alone changes nothing (slope 0), one that knows the motion changes as the truth does (correlation and slope 1).
#pragma once

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// How far a label's pixels reach in a picture, in metres at the pelvis' depth, measured from the projected pelvis.
struct LabelExtent {
  static constexpr std::array<const char*, 4> kNames = {"left_m", "right_m", "bottom_m", "area_m2"};
  /// The 3rd and the 97th hundredth of its columns, the 97th of its rows (down), its area. NaN with fewer than 20
  /// pixels.
  std::array<double, 4> values;
};

/// `labels` (a label's index in all channels) shows frame t of the track. Throws std::invalid_argument when the pelvis
/// is not in front of the camera.
LabelExtent MeasureLabelExtent(const Image& labels, PersonLabel label, const Track& track, int t);

/// Pairs (frame of a, frame of b), in order: poses equal to 1e-3 rad, places to 1 cm. Left out are the first
/// `frames_after_gap` (≥ 0) frames of each gap-free run (geometry/uv_maps/velocity_stencil.h), whose past is not of
/// their speed.
std::vector<std::pair<int, int>> PairFramesByPose(const Track& a, const Track& b, int frames_after_gap);

struct SpeedReaction {
  struct OfExtent {
    double truth_std = 0, result_std = 0;  ///< of the change from speed to speed, over the pairs
    double correlation = std::numeric_limits<double>::quiet_NaN();  ///< of the two changes; NaN: one is constant
    double slope = std::numeric_limits<double>::quiet_NaN();        ///< Σ truth·result / Σ truth²
  };
  PersonLabel label = PersonLabel::kBottom;
  int pairs = 0;  ///< with the label in all four pictures
  std::array<OfExtent, 4> extents;
  double truth_iou = 0, result_iou = 0;  ///< of the label between the two speeds, mean over the pairs

  /// A quarter of the pairs, by how much the truth's label differs between the two speeds (its IoU); pairs that differ
  /// equally stay in order. Whoever knows the motion is better where much differs.
  struct Quarter {
    int pairs = 0;
    double between_speeds = 0;      ///< mean IoU of the truth at one speed with the truth at the other
    double iou = 0, other_iou = 0;  ///< mean IoU of each result with its truth
  };
  std::array<Quarter, 4> quarters;  ///< from least to most different; sizes differ by one at most
};

/// Truths and results at two speeds; each result has the frames of its truth. Throws std::runtime_error naming a set
/// that lacks labels, has another number of frames or another size, or when no frame shows the same pose.
SpeedReaction MeasureSpeedReaction(const SinglePersonDataset& truth, const SinglePersonDataset& result,
                                   const SinglePersonDataset& other_truth, const SinglePersonDataset& other_result,
                                   PersonLabel label, int num_threads);

}  // namespace bodyloom
