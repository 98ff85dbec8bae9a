// SPDX-License-Identifier: Apache-2.0
/// Reads OpenPose's JSON: {"version": 1.3, "people": [{"person_id": [-1], "pose_keypoints_2d": [x, y, c, …], …}]} per
/// frame.
///
/// x and y are pixels, c is in [0, 1], 0,0,0 means missing. The order of people is arbitrary. `people` may be empty and
/// may hold empty objects. The number of landmarks determines the model, except that BODY_25 and BODY_25B both have 25:
/// in BODY_25 landmark 1 lies between landmarks 2 and 5 (a neck between shoulders), in BODY_25B the first three form a
/// face. Also read: a list of such frames in one file, a table {"12.jpg": {"people": …}}, and the older key
/// "pose_keypoints". hand_left_keypoints_2d, hand_right_keypoints_2d (21 each) and face_keypoints_2d (70) are the
/// person's hands and face. Source: OpenPose doc/02_output.md.
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

/// Reads a folder with one JSON file per frame; frame numbers come from the file names (frame_numbers.h), or from their
/// order if a name has no number. `convention` is "" (detect), "body25", "body25b", "openpose_coco18", "coco17" or
/// "halpe26". Broken files and warnings as in ReadJsonFrames(). Throws std::runtime_error naming the file and place.
PeopleSequence ReadOpenPoseFolder(const std::string& folder, double fps, const std::string& convention = "",
                                  std::vector<std::string>* warnings = nullptr);

/// Returns true if a parsed file has one of OpenPose's forms.
bool IsOpenPoseJson(const JsonNode& document);
PeopleSequence OpenPoseFromJson(const JsonNode& document, double fps, const std::string& convention = "");

}  // namespace bodyloom
