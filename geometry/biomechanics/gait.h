// SPDX-License-Identifier: Apache-2.0
/// Events and figures of gait: foot strikes and foot offs, cadence, step length and time, walking speed.
///
/// The pelvis' velocity v is the slope of the line through the mid-hip's horizontal places within 0.5 s; its direction
/// is d. Along d, relative to the mid-hip and averaged over 0.1 s,
///   foot strike   the ankle is furthest ahead
///   foot off      the ball of the foot is furthest behind
/// at the vertex of the parabola through three frames, between which extremes the foot swings by more than 0.15 leg
/// lengths L. Somebody walks where for four strikes and more
///   the pelvis faces d within 60° and moves at 0.1 to 0.77 √(gL) (0.3 to 2.3 m/s for L = 0.9 m),
///   left and right strike in turn, 0.25 to 1.5 s apart, each at least 0.15 L ahead of the other foot, and
///   in four of five frames a foot stands: its ankle or ball moves at less than half the pelvis' speed, or 0.3 m/s.
/// Walking on the spot or on a treadmill does not move the pelvis and is none; so are running, and steps backwards or
/// to the side. Only frames with a pose count, and nothing is measured across a gap of more than 2.5 frames.
/// The extremes come about 0.02 s before a foot stands still and after it leaves the ground.
///
/// Source: Zeni, Richards, Higginson, "Two simple methods for determining gait events during treadmill and overground
/// walking using kinematic data", Gait & Posture 27 (2008); L and √(gL): the Froude number, 0.6 at the upper end.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

enum class Foot { kLeft = 0, kRight = 1 };
enum class GaitEventKind { kFootStrike, kFootOff };

struct GaitEvent {
  double seconds = 0;  ///< the track's clock
  int frame = 0;       ///< nearest
  Foot foot = Foot::kLeft;
  GaitEventKind kind = GaitEventKind::kFootStrike;
};

/// Figures are NaN, and the lists empty, where nobody walks.
struct GaitReport {
  bool walks = false;
  std::string reason;                              ///< one line, where nobody walks
  std::vector<GaitEvent> events;                   ///< of the bouts, in order of time
  std::vector<std::pair<double, double>> bouts_s;  ///< first and last strike of each stretch of walking
  int num_steps = 0;                               ///< from one foot's strike to the next one of the other
  double cadence_per_min;                          ///< steps a minute
  double step_time_s;                              ///< mean
  /// Of the left, the right foot: mean way from the other ankle's strike to its own strike; in the track's own scale.
  std::array<double, 2> step_length_m;
  double speed_mps;  ///< of the mid-hip, in straight lines from strike to strike

  GaitReport();
  [[nodiscard]] double mean_step_length_m() const { return 0.5 * (step_length_m[0] + step_length_m[1]); }
  /// One line without a newline.
  [[nodiscard]] std::string BriefReport() const;
};

/// Places over time, metres, in a world with y up; rows that are not finite are frames without a pose.
struct GaitPlaces {
  std::vector<double> timestamps;                ///< T seconds, ascending
  std::array<MatrixX3d, 2> hips, ankles, balls;  ///< left, right: T×3 each; balls of the feet
  double leg_length_m = 0;
};

/// Throws std::invalid_argument when sizes differ or leg_length_m is not above 0.
GaitReport AnalyseGait(const GaitPlaces& places);

/// Of a track's joints. Throws std::invalid_argument for a body without hips, knees, ankles and feet, or a track with
/// more joints than it.
GaitReport AnalyseGait(const BodyModel& body, const Track& track, const WorldFrame& world);

}  // namespace bodyloom
