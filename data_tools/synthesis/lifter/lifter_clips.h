// SPDX-License-Identifier: Apache-2.0
/// Motions in compact form, sampled at any speed.
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

/// `motion`: 24 or more joints, y up, on a flat floor when has_floor. The floor's height is measured with this body
/// (sources differ in the pelvis' height): the 10th percentile of the heights of the body's lowest point. Clearances up
/// to 2 cm become 0, those from 8 cm on are kept. Throws std::invalid_argument with the reason when the motion cannot
/// be used (inconsistent arrays, non-finite values, y not up, irregular or missing timestamps, one frame).
LifterClip CompactClip(const Motion& motion, bool has_floor, const LifterBody& body);

/// Frames at start_s + i·step_s; beyond the clip's ends time is reflected.
void SampleClip(const LifterClip& clip, double start_s, double step_s, int num_frames, PoseSequence* poses);

/// The same for the listed joints alone, written into `poses` (which has frames already): target[i] takes the rotations
/// of source[i], mirrored when requested.
void SampleJoints(const LifterClip& clip, double start_s, double step_s, const std::vector<int>& source,
                  const std::vector<int>& target, bool mirror, PoseSequence* poses);

/// Mirrors left and right: x → −x.
void MirrorPoses(PoseSequence* poses);

}  // namespace bodyloom
