// SPDX-License-Identifier: Apache-2.0
/// Quality of a recorded motion: statistics of one clip, and flags for suspicious values.
///
/// Joints are those of the mean SMPL skeleton (smpl_rest.h); velocities are differences of neighbouring frames,
/// accelerations second differences. `y = 0` is the floor (data_tools/motion/motion_floor.h).
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/track.h"

namespace bodyloom {

struct MotionQuality {
  int frames = 0;
  double seconds = 0, fps = 0;
  /// Share of the frames with a joint more than 5° beyond its limits (tracking/terms/joint_limits.h), and the largest
  /// excess: of the body, and of the limbs' ends (ankles, toes, wrists), which are the least reliable in recordings.
  double beyond_limits_share = 0, worst_excess_deg = 0;
  std::string worst_excess_joint;  ///< empty if none is beyond
  double ends_beyond_limits_share = 0, ends_worst_excess_deg = 0;
  std::string ends_worst_excess_joint;
  /// Foot sliding: of the steps in which a toe joint is less than 5 cm + its clearance above the floor at both ends and
  /// moves up or down slower than 0.2 m/s, the mean horizontal speed of the slower such toe, m/s, and its 95th
  /// percentile. The supporting foot should be stationary. NaN without such steps or without a floor. A dancer's slide
  /// and a runner's low swing count as sliding too.
  double foot_sliding_m_s = 0, foot_sliding_p95_m_s = 0;
  double contact_share = 0;  ///< share of the steps with such a toe
  /// Share of the frames whose lowest point is more than 5 cm below the floor, and the deepest.
  double sunk_share = 0, deepest_m = 0;
  /// Joint rotations of two successive steps, each faster than 20 rad/s, in opposite directions (the angle between
  /// their axes above 120°): markers swapped for a frame, or angles that wrapped around.
  int flips = 0, ends_flips = 0;
  double worst_speed_m_s = 0;  ///< of a joint relative to the pelvis
  std::string worst_speed_joint;
  double worst_acceleration_m_s2 = 0;
  std::string worst_acceleration_joint;
  double worst_turn_rad_s = 0;  ///< of a joint relative to its parent
  std::string worst_turn_joint;
  /// Names of suspicious properties: "limits" (the body beyond in more than 20 % of the frames, or by more than 40°),
  /// "ends" (the same of the ends), "flips" (of the body), "foot_sliding" (above 0.3 m/s in the mean), "sunk" (more
  /// than 10 % of the frames), "speed" (above 20 m/s), "acceleration" (above 1000 m/s²: artefacts), "upside_down" (the
  /// head below the pelvis in more than half of the frames).
  std::vector<std::string> flags;
};

/// The motion must have 24 joints, y up and a regular clock; throws std::invalid_argument otherwise. Without a flat
/// floor (`has_floor` false) foot sliding and sinking are NaN.
MotionQuality MeasureMotionQuality(const Motion& motion, bool has_floor);

}  // namespace bodyloom
