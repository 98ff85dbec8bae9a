// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bodyloom/data_tools/descriptors/surface_motion.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Similarity of each frame's motion to those of other frames: the largest normalised cross-correlation, in [−1, 1], of
/// its motion descriptor (normals and the velocities of `past` frames over an atlas of 32², in the axes of `motion`)
/// with that of any frame of `others`, which may be the same track (then 1). `counts` has an entry a frame of `others`,
/// 0 for those that are only there for the velocities of their neighbours; empty: all count. NaN for a frame without a
/// result, and where no frame of `others` counts. Yoon et
/// al., CVPR 2022, Fig. 6.
/// Memory: 4 · 1024 · (3 + 3 past) bytes a frame of both. Throws as PersonFrames, and std::invalid_argument for another
/// number of `counts`.
std::vector<float> SimilarityToNearest(const BodyModel& body, const Track& track, const Track& others, int past,
                                       int num_threads, const SurfaceMotion& motion = {},
                                       std::span<const char> counts = {});

}  // namespace bodyloom
