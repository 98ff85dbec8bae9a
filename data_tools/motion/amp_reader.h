// SPDX-License-Identifier: Apache-2.0
/// AMP / poselib motions: a .npy of one pickled object,
///   {rotation: {arr T×J×4}, root_translation: {arr T×3}, skeleton_tree: {node_names, parent_indices: {arr J},
///    local_translation: {arr J×3}}, is_local, fps}.
/// Quaternions are (x, y, z, w), relative to the parent when is_local; metres; z up, x forward, y left.
/// Source: NVIDIA IsaacGymEnvs, poselib/poselib/skeleton/skeleton3d.py.
#pragma once

#include <string>

#include "data_tools/motion/skeleton_motion.h"

namespace bodyloom {

/// Throws std::runtime_error naming `where`, the key, what it holds and what was expected.
SkeletonMotion AmpFromNpyBytes(const std::string& bytes, const std::string& where);

}  // namespace bodyloom
