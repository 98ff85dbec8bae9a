// SPDX-License-Identifier: Apache-2.0
/// Writes a motion as BVH for animation programs: the body's joints (rest positions of the motion's shape) in
/// centimetres, y up, rotation channels Z X Y (R = Rz·Rx·Ry), degrees. Ends of chains get a short End Site. Names and rest
/// pose are a rig's (bvh_rig.h).
#pragma once

#include <string>

#include "bodyloom/data_tools/motion/bvh_rig.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// The motion may have fewer joints than the body (the rest stay at rest). Motions with z up or in camera coordinates
/// are turned (motion_tools.h). BVH has one frame time: a motion with a gap is refused, resample it first. Throws
/// std::invalid_argument for such motions, std::runtime_error when the file cannot be written.
void WriteBvh(const std::string& path, const Motion& motion, const BodyModel& model, BvhRig rig = BvhRig::kSmpl);
std::string BvhText(const Motion& motion, const BodyModel& model, BvhRig rig = BvhRig::kSmpl);

}  // namespace bodyloom
