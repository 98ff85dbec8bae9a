// SPDX-License-Identifier: Apache-2.0
/// Oracle of the lifter: its predictions with a part of the truth, which show where a track's error comes from.
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

/// The lifter's reading of `keypoints` as the tracker would make it, corrected by the truth (T frames of COCO-17,
/// camera axes, any unit): "truth", "torso", "lean", "best", "arms" or "legs" as bodyloom_bench_aist says; throws
/// std::invalid_argument for another word. Frames whose truth is not finite stay as they are.
std::vector<LiftedFrame> LiftWithOracle(const KeypointSequence& keypoints, CameraKnowledge knowledge,
                                        const Camera& camera, const LifterWeights& weights,
                                        const std::vector<MatrixX3d>& truth, const std::string& oracle);

// The "lifter" option of the benchmarks.

/// "built-in", "none" (null) or a file of weights; lives as long as the program. Throws as ReadLifterWeights.
const LifterWeights* LifterOf(const std::string& name);

}  // namespace bodyloom
