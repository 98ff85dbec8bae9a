// SPDX-License-Identifier: Apache-2.0
/// AIST++ keypoint files (pickles).
///
/// keypoints2d/<seq>.pkl: `keypoints2d` V×T×17×3 (25×3 when made with OpenPose) with x, y in pixels of the 1920×1080
/// video and a score, NaN where a frame has no detection; `det_scores` V×T; `timestamps` T, microseconds. Views are the
/// cameras c01, c02, … in order. One person per frame. Some scores exceed 1 slightly and are clamped.
/// keypoints3d/<seq>.pkl: `keypoints3d` and `keypoints3d_optim`, T×17×3 COCO, centimetres, y up.
/// Source: google/aistplusplus_api, loader.py and run_preprocessing.py.
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/pickle.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

bool IsAistKeypoints2d(const PickleValue& file);
/// The detections of one view ("c01" …; "" means the only view, an error when there are several). `fps` is used when
/// the file has no timestamps. Throws std::runtime_error naming `where`, what was found and, for a missing view, the
/// views present.
KeypointSequence AistKeypoints2dFromPickle(const PickleValue& file, const std::string& where, const std::string& view,
                                           double fps);

/// Joints of every frame (17×3 metres, world frame with y up): keypoints3d_optim, or the raw triangulation.
std::vector<MatrixX3d> ReadAistKeypoints3d(const std::string& path, bool optimised = true);

}  // namespace bodyloom
