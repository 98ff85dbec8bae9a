// SPDX-License-Identifier: Apache-2.0
/// Writes a motion as BVH for animation programs: the body's joints (rest positions of the motion's shape) in
/// centimetres, y up, rotation channels Z X Y (R = Rz·Rx·Ry), degrees. Ends of chains get a short End Site. Names and
/// rest pose are those of a rig (animation_rig.h); joints that it has no name for, SMPL's two of the hands, are left
/// out.
#pragma once

#include <string>

#include "data_tools/motion/animation_rig.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// The motion may have fewer joints than the body (the others stay at rest). Motions with z up or in camera coordinates
/// are converted (motion_tools.h). BVH has a single frame time, so a motion with a gap must be resampled first. Throws
/// std::invalid_argument for such motions and as RigSkeletonOf(), std::runtime_error when the file cannot be written.
void WriteBvh(const std::string& path, const Motion& motion, const BodyModel& model,
              AnimationRig rig = AnimationRig::kSmpl);
std::string BvhText(const Motion& motion, const BodyModel& model, AnimationRig rig = AnimationRig::kSmpl);

}  // namespace bodyloom
