// SPDX-License-Identifier: Apache-2.0
/// Reads the JSON of easy_ViTPose (inference.py --save-json):
///   {"keypoints": [{"0": [[y, x, confidence], …], "1": …}, …], "skeleton": {"0": "nose", …}}
/// with one table per frame, people by their number, which is an identity in a video. y comes before x, pixels.
///
/// `skeleton` names the landmarks: COCO's 17, easy_ViTPose's 25 (COCO with neck, hip and feet), COCO-WholeBody's 133,
/// or any that have some of a person's landmarks. Without all names the order is COCO's of that number. Source:
/// JunkyByte/easy_ViTPose, inference.py, easy_ViTPose/vit_utils/visualization.py (joints_dict).
#pragma once

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

bool IsVitPoseJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence VitPoseFromJson(const JsonNode& document, double fps);

}  // namespace bodyloom
