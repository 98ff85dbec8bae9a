// SPDX-License-Identifier: Apache-2.0
/// Reads landmarks that people save as a bare array (.npy, or the only array of an .npz): frames × points × 3 with x, y
/// in pixels and a confidence, or × 2 without one (then it is 1), NaN where a landmark is missing; or several of them,
/// one for each camera or person.
///
/// 17 points are COCO's, 23 or 133 COCO-WholeBody's, 26 or 136 Halpe's; a convention given by the caller is taken as it
/// is. Without one the array must not be mistaken:
/// - The third numbers must lie in [0, 1] and people must be 20 units tall or wide (the median frame): metres would not
///   reach that, and of centimetres or millimetres the depth of a person spans more than 1. Arrays that do not are 3D
///   points or fractions of the image.
/// - Of 17 points the first five, COCO's face, must span less than 0.4 of all (the median frame); in Human3.6M's order
///   they are hips, knee and ankle.
/// With a convention the third numbers must not be negative, and the numbers may be fractions (load_detections.h).
#pragma once

#include <string>

#include "data_tools/formats/npz.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// Returns the array of landmarks of an archive without the keys of this project's own form: `keypoints`, or the only
/// array of numbers. nullptr if there is none.
const NdArray* KeypointArrayOf(const NpzArrays& arrays);

/// `view` chooses one of N × frames × points: "0", "1", … in the array's order, "" when there is one. `convention` is
/// "" or the name of one of KnownConventions(). Throws std::runtime_error naming `where`, what was found and what to
/// give.
KeypointSequence KeypointsFromArray(const NdArray& array, const std::string& where, const std::string& view, double fps,
                                    const std::string& convention);

}  // namespace bodyloom
