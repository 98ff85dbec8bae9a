// SPDX-License-Identifier: Apache-2.0
/// Mends and takes apart a recorded motion where no person could have moved so: lost or swapped markers, angles that
/// went the wrong way around, T-poses before the first frame, gaps in the clock.
///
/// 1. Feet are mended: where an ankle is more than 110° from the T-pose's rotation, it gets the shortest turn from the
///    T-pose that points the toes where they point. CMU's solver turns feet over about their own axis for seconds while
///    every joint is where it should be. (It does so with hands, too; they are left, nothing hangs on them.)
/// 2. Frames are broken, and left out, where a thigh is rolled about its own axis by more than 110° (the knee then
///    bends backwards) or the chest is turned by more than 110° against the pelvis (some
///    recordings bend the lowest joint of the spine alone, by 90° in a squat). The roll is what is left when the
///    shortest turn has taken a half-raised thigh (70° forward) to where the thigh is: counted from a hanging one, deep
///    squats with the knees apart and people who lie down with their legs drawn up would seem rolled.
/// 3. The motion is cut at impossible steps and at gaps. What lies within 0.04 s of an impossible step or a broken
///    frame goes with it, because recordings are smoothed over such places; so do pieces that are too short.
#pragma once

#include <vector>

#include "geometry/scene/track.h"

namespace bodyloom {

/// The limits lie above what people do (a kick's foot reaches 18 m/s against the pelvis, a sprinter 12 m/s, a
/// somersault 15 rad/s), so that they exclude the impossible only; a baseball pitcher's hand, at 35 m/s, needs a higher
/// one.
struct MotionCleaningOptions {
  double max_pelvis_speed_m_s = 15;  ///< between two frames
  double max_joint_speed_m_s = 22;   ///< of any joint relative to the pelvis
  double max_root_turn_rad_s = 40;
  double margin_s = 0.04;     ///< left out on both sides of an impossible step and of a broken frame
  double longest_step = 1.5;  ///< a longer step of the clock than this times the median is a gap
  double min_piece_s = 0.5;   ///< shorter pieces are dropped
};

struct CleanedMotion {
  std::vector<Motion> pieces;  ///< in order, timestamps as they were
  int frames_mended = 0;       ///< with at least one ankle
  int frames_broken = 0;
  int jumps = 0;  ///< steps faster than the limits
  int gaps = 0;
  int frames_dropped = 0;  ///< in all: broken, too near to a fault, in a piece that was too short
};

/// Needs 24 joints with y up; throws std::invalid_argument otherwise.
CleanedMotion CleanMotion(const Motion& motion, const MotionCleaningOptions& options = {});

/// Frames [begin, end) of a motion.
Motion FramesOf(const Motion& motion, int begin, int end);

}  // namespace bodyloom
