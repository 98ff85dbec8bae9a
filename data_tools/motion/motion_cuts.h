// SPDX-License-Identifier: Apache-2.0
/// Takes a recorded motion apart where no person could have moved so: lost markers, swapped labels, gaps in the clock.
#pragma once

#include <vector>

#include "geometry/track.h"

namespace bodyloom {

/// The limits lie well above what people do (a kick's foot reaches 20 m/s against the pelvis, a sprinter 12 m/s, a
/// somersault 15 rad/s), so that they exclude the impossible only.
struct MotionCutOptions {
  double max_pelvis_speed_m_s = 15;  ///< between two frames
  double max_joint_speed_m_s = 30;   ///< of any joint relative to the pelvis
  double max_root_turn_rad_s = 40;
  double longest_step = 1.5;         ///< a longer step of the clock than this times the median is a gap
  double min_piece_s = 0.5;          ///< shorter pieces are dropped
};

struct MotionCuts {
  std::vector<Motion> pieces;  ///< in order, timestamps as they were
  int jumps = 0;               ///< steps faster than the limits
  int gaps = 0;
  int frames_dropped = 0;      ///< of pieces that were too short; a frame of garbage is such a piece
};

/// Cuts at every impossible step and at every gap. Needs 24 joints with y up; throws std::invalid_argument otherwise.
MotionCuts CutMotion(const Motion& motion, const MotionCutOptions& options = {});

/// Frames [begin, end) of a motion.
Motion FramesOf(const Motion& motion, int begin, int end);

}  // namespace bodyloom
