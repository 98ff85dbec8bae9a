// SPDX-License-Identifier: Apache-2.0
/// Repairs or splits a recorded motion at movements that are physically impossible: lost or swapped markers, angles
/// that wrapped around, T-poses before the first frame, gaps in the timestamps.
///
/// 1. Feet are repaired: an ankle more than 110° from the T-pose's rotation gets the shortest rotation from the T-pose
///    that keeps the direction of the toes. CMU's solver turns feet over about their own axis for seconds while every
///    joint is at its place. (Hands have the same fault and are not repaired, as no other joint depends on them.)
/// 2. Frames are dropped as broken if a thigh is rolled about its own axis by more than 110° (the knee then bends
///    backwards) or the chest is turned by more than 110° against the pelvis (some recordings bend the lowest joint of
///    the spine alone, by 90° in a squat). The roll is what remains after the shortest rotation of a half-raised thigh
///    (70° forward) to the thigh's direction: relative to a hanging thigh, deep squats with the knees apart and people
///    who lie with their legs drawn up would appear rolled.
/// 3. The motion is cut at impossible steps and at gaps. Frames within 0.04 s of an impossible step or a broken frame
///    are dropped too, because recordings are smoothed across them; so are pieces that are too short.
#pragma once

#include <vector>

#include "geometry/scene/track.h"

namespace bodyloom {

/// The limits are above those of people (a kick's foot reaches 18 m/s relative to the pelvis, a sprinter 12 m/s, a
/// somersault 15 rad/s), so that they exclude only impossible steps; a baseball pitcher's hand, at 35 m/s, needs a
/// higher limit.
struct MotionCleaningOptions {
  double max_pelvis_speed_m_s = 15;  ///< between two frames
  double max_joint_speed_m_s = 22;   ///< of any joint relative to the pelvis
  double max_root_turn_rad_s = 40;
  double margin_s = 0.04;     ///< dropped on both sides of an impossible step and of a broken frame
  double longest_step = 1.5;  ///< a time step longer than this times the median is a gap
  double min_piece_s = 0.5;   ///< shorter pieces are dropped
};

struct CleanedMotion {
  std::vector<Motion> pieces;  ///< in order, with the original timestamps
  int frames_mended = 0;       ///< frames with a repaired ankle
  int frames_broken = 0;
  int jumps = 0;  ///< steps faster than the limits
  int gaps = 0;
  int frames_dropped = 0;  ///< total: broken, too near to a fault, or in a piece that was too short
};

/// The motion must have 24 joints and y up; throws std::invalid_argument otherwise.
CleanedMotion CleanMotion(const Motion& motion, const MotionCleaningOptions& options = {});

/// Frames [begin, end) of a motion.
Motion FramesOf(const Motion& motion, int begin, int end);

}  // namespace bodyloom
