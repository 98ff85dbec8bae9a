// SPDX-License-Identifier: Apache-2.0
/// Motions and options shared by the tests of the lifter's training windows.
#pragma once

#include <cmath>
#include <vector>

#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/lifter/lifter_windows.h"
#include "tests/support/toy_body.h"

namespace bodyloom {

inline Motion ShortDemoMotion() { return DemoMotion(ToyBody(), 360, 60); }

/// Only clip, start, person and camera are random: exact detections of the recorded motion.
inline LifterWindowOptions PlainOptions() {
  LifterWindowOptions o;
  o.moving_camera = o.mirror = o.arm_exchange = o.leg_exchange = o.spine_exchange = 0;
  o.perturbation = o.squat = o.leg_raise = o.kick = o.arm_raise = o.reach = o.bend = o.lean = o.floor_poses = 0;
  o.spin = o.tumble = o.any_elevation = 0;
  o.shape_sd = o.bone_noise = o.landmark_sd_m = o.biased_detector = 0;
  o.noise = o.dropout = o.pair_swap = o.body_swap = o.no_feet = o.no_face = 0;
  o.missing_limb = o.missing_lower_half = o.nothing = o.image_border = o.cut_off = 0;
  o.constant_confidence = o.confidence_spread = 0;
  o.focal_known = 1;
  return o;
}

/// Left and right exchanged, x negated, by hand on the files' axis-angles.
inline Motion MirroredMotion(const Motion& motion) {
  Motion mirrored = motion;
  for (int t = 0; t < motion.num_frames(); ++t) {
    for (int j = 0; j < 24; ++j) {
      const int twin = toy_body_internal::MirrorJoint(j);
      mirrored.poses(t, 3 * j) = motion.poses(t, 3 * twin);
      mirrored.poses(t, 3 * j + 1) = -motion.poses(t, 3 * twin + 1);
      mirrored.poses(t, 3 * j + 2) = -motion.poses(t, 3 * twin + 2);
    }
    mirrored.trans(t, 0) = -motion.trans(t, 0);
  }
  return mirrored;
}

inline LifterWindowGenerator Generator(const LifterWindowOptions& options, const Motion& motion = ShortDemoMotion()) {
  return LifterWindowGenerator({motion}, {1}, ToyBody(), options);
}

}  // namespace bodyloom
