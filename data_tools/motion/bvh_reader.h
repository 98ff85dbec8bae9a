// SPDX-License-Identifier: Apache-2.0
/// Biovision hierarchies (.bvh, .bvh.gz): any skeleton, any order of channels.
///
/// HIERARCHY names joints with offsets and channels; MOTION holds one line of numbers per frame, degrees. Rotation
/// channels multiply in the order they are listed: "Zrotation Yrotation Xrotation" is Rz·Ry·Rx. The root's position
/// channels are its position; position channels of other joints are ignored (bones keep their lengths). Units are those
/// of the writer. Keywords and channels may be in small letters, "Frames:" and "Time:" need no blank behind them.
/// Source: Meredith and Maddock, "Motion Capture File Formats Explained".
#pragma once

#include <string>
#include <vector>

#include "data_tools/motion/skeleton_motion.h"

namespace bodyloom {

SkeletonMotion ReadBvh(const std::string& path);
/// Reads the whole frames that are there; if their number is not the stated one, `warnings`, when requested, gets a
/// line with both. Throws std::runtime_error "where: line N: …".
SkeletonMotion BvhFromText(const std::string& text, const std::string& where,
                           std::vector<std::string>* warnings = nullptr);

}  // namespace bodyloom
