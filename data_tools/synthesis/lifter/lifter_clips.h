// SPDX-License-Identifier: Apache-2.0
/// Motions in compact form, and stretches of them at any speed.
#pragma once

#include <vector>

#include "data_tools/synthesis/lifter/lifter_body.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// A motion at about kLifterClipRate frames a second.
struct LifterClip {
  double rate = 0, duration_s = 0;
  PoseSequence poses;
};

inline constexpr double kLifterClipRate = 60;  ///< faster motions are resampled to it

/// `motion`: 24 or more joints, y up, on a flat floor when has_floor. Where that floor is, is measured on this body (it
/// stands on its own soles, and sources differ in where the pelvis is): the height below which the body's lowest point
/// is in one frame of ten. Up to 2 cm above it is on it, from 8 cm on it is as high as it is. Throws
/// std::invalid_argument with the reason when the motion cannot be used (arrays that do not fit, values that are not
/// finite, y is not up, an uneven or missing clock, one frame).
LifterClip CompactClip(const Motion& motion, bool has_floor, const LifterBody& body);

/// Frames at start_s + i·step_s; beyond the clip's ends time runs back and forth (a clip is a pendulum).
void SampleClip(const LifterClip& clip, double start_s, double step_s, int num_frames, PoseSequence* poses);

/// The same for the listed joints alone, written into `poses` (which has frames already): target[i] takes the rotations
/// of source[i], mirrored when requested.
void SampleJoints(const LifterClip& clip, double start_s, double step_s, const std::vector<int>& source,
                  const std::vector<int>& target, bool mirror, PoseSequence* poses);

/// Left becomes right: x → −x.
void MirrorPoses(PoseSequence* poses);

}  // namespace bodyloom
