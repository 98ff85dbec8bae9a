// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bodyloom/data_tools/descriptors/surface_motion.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Similarity of each frame's motion to those of other frames: the largest normalised cross-correlation, in [−1, 1], of
/// its motion descriptor (normals and the velocities of `past` frames over an atlas of 32², in the axes of `motion`)
/// with that of any frame of `others`, which may be the same track (then 1). NaN for a frame without a result. Yoon et
/// al., CVPR 2022, Fig. 6.
/// Memory: 4 · 1024 · (3 + 3 past) bytes a frame of both. Throws as PersonFrames.
std::vector<float> SimilarityToNearest(const BodyModel& body, const Track& track, const Track& others, int past,
                                       int num_threads, const SurfaceMotion& motion = {});

}  // namespace bodyloom
