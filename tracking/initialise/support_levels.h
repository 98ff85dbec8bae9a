// SPDX-License-Identifier: Apache-2.0
/// Finds the heights at which a person is supported, by any part of the body: a floor on which somebody sits, lies or
/// runs, and further levels such as a box, a wall or a stage.
///
/// The evidence is the lowest point of the body in each frame, with the weight
///   w = Δt / (1 + (v / kRestSpeed)²)
/// Δt: time that the frame stands for, v: speed of the point. In flight the lowest point moves, so its frames hardly
/// count; at the top of a flight or of a bounce, from which it falls on both sides with more than kMaxFall, not at all.
/// The main level is the weighted mean of the heights in the window of 2 kLevelHalfWidthM that has the largest weight.
/// It is found when frames at rest (v <= kRestSpeed) within kOnLevelM of it last kMinRest_s, since somebody who glides
/// or swims never rests, and when kMinRestShare of the whole weight is there; a climber rests at all heights.
///
/// Other levels are the same of what is left farther than kApartM from all levels so far. Each needs a weight of
/// kMinLevel_s, kMinRest_s of rest, and a height that a wrong vertical does not explain: |Δh| > 3 σ_up d, d the
/// horizontal distance of the mean places. Levels are parallel.
///
/// A frame at rest within kOnLevelM of a level belongs to it. Others belong to that of the nearest such frame before or
/// after, the lower one of the two, since a jump ends on either.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bodyloom {

inline constexpr double kRestSpeed = 0.5;         ///< m/s
inline constexpr double kMaxFall = 2.5;           ///< m/s², of a point that rests
inline constexpr double kLevelHalfWidthM = 0.04;  ///< of one level, by the track's errors and raised heels
inline constexpr double kOnLevelM = 0.12;
inline constexpr double kApartM = 0.25;  ///< of levels; lower steps are within what a track hovers wrongly
inline constexpr double kMinRest_s = 0.15, kMinLevel_s = 0.5;
inline constexpr double kMinRestShare = 0.5;

/// The lowest point of the body in one frame.
struct LowestPoint {
  double seconds = 0;
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();  ///< camera frame, or the scene of a camera that moves
  double speed_mps = 0;
  bool supports = false;  ///< false: it is not evidence, because it is not known or the person may hang
};

struct SupportLevel {
  double level_m = 0;  ///< up · x on it
  double seconds = 0;  ///< Σ w of the frames on it
  double sigma_m = 0;  ///< of level_m for the given vertical; NaN of a level that is given
};

struct SupportLevels {
  std::string why;                   ///< the evidence of the main level, or the reason why none was found
  std::vector<SupportLevel> levels;  ///< the main one first; none when it was not found
  std::vector<int> of_frame;         ///< index into `levels`, by frame
};

/// `points` in the order of time, of one shot. `up`: unit. `main_level_m`: the main level where it is known.
SupportLevels FindSupportLevels(std::span<const LowestPoint> points, const Eigen::Vector3d& up, double up_sigma_rad,
                                std::optional<double> main_level_m = std::nullopt);

}  // namespace bodyloom
