// SPDX-License-Identifier: Apache-2.0
/// DeepMimic motions (humanoid3d_*.txt, JSON): {"Loop": …, "Frames": [[…]·44]}.
///
/// A frame is: its duration (s), root position (m), then unit quaternions (w, x, y, z) of root, chest, neck, right hip,
/// [knee angle], right ankle, right shoulder, [elbow angle], and the same for the left side; knees and elbows turn
/// about z. World: y up, x forward, z right; legs and arms hang at rest. The skeleton (joint offsets, metres) is fixed.
/// Source: Peng et al., DeepMimic, data/motions and data/characters/humanoid3d.txt.
#pragma once

#include "data_tools/formats/json_reader.h"
#include "data_tools/motion/skeleton_motion.h"

namespace bodyloom {

bool IsDeepMimicJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
SkeletonMotion DeepMimicFromJson(const JsonNode& document);

}  // namespace bodyloom
