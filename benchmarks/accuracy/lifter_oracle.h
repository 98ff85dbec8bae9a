// SPDX-License-Identifier: Apache-2.0
/// Oracle of the lifter: its predictions with a part replaced by the truth, to attribute a track's error.
#pragma once

#include <string>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "tracking/lifter/lift_keypoints.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// The lifter's result for `keypoints` as in the tracker, corrected by the truth (T frames of COCO-17, camera axes, any
/// unit). `oracle` is "truth", "torso", "lean", "best", "arms" or "legs" as in bodyloom_bench_aist; throws
/// std::invalid_argument for another word. Frames whose truth is not finite are unchanged.
std::vector<LiftedFrame> LiftWithOracle(const KeypointSequence& keypoints, CameraKnowledge knowledge,
                                        const Camera& camera, const LifterWeights& weights,
                                        const std::vector<MatrixX3d>& truth, const std::string& oracle);

// The "lifter" option of the benchmarks.

/// "built-in", "none" (null) or a file of weights; lives as long as the program. Throws as ReadLifterWeights.
const LifterWeights* LifterOf(const std::string& name);

}  // namespace bodyloom
