// SPDX-License-Identifier: Apache-2.0
/// Landmarks by the names that people and detectors give them, in the vocabulary of keypoint_conventions.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"

namespace bodyloom {

/// Returns a landmark's name in lower case with underscores, the side in front: "LEFT_FOOT_INDEX" → "left_big_toe",
/// "left_big toe" → "left_big_toe", "LShoulder", "shoulder_l" and "leftShoulder" → "left_shoulder", "hip", "hips" and
/// "pelvis" without a side → "mid_hip", "thorax" → "neck". Other names come back in that spelling.
std::string LandmarkNameFrom(std::string_view text);

/// Returns the convention that has these names (as LandmarkNameFrom() gives them) in this order, for 133 and 136 names
/// the one that has the first of them (ConventionOfCount()), else one called "custom".
KeypointConvention ConventionOfNames(const std::vector<std::string>& names);

/// Returns true if a name is one of COCO's, a toe, a heel, or the neck, mid-hip or top of the head: a person's.
bool IsPersonLandmark(const std::string& name);

}  // namespace bodyloom
