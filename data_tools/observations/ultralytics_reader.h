// SPDX-License-Identifier: Apache-2.0
/// Reads the JSON of Ultralytics' pose models, Results.to_json() (tojson() before 8.3): the list of an image's
/// detections
///   {"name": "person", "class": 0, "confidence": 0.9, "box": {…}, "track_id": 3, "keypoints": {"x": […], "y": […],
///    "visible": […]}},
/// alone (one image; a folder has one such file per image) or in a list of the frames, also as JSON Lines.
///
/// x and y are pixels, or fractions of the image with normalize=True; `visible` is the confidence, 1 if it is not
/// there. Landmarks at exactly (0, 0) are missing, as Ultralytics sets those below a confidence of 0.5 there.
/// `track_id` is the identity, of model.track(). 17 landmarks (COCO) and other orders of ConventionOfCount() are read.
/// Source: ultralytics/ultralytics, engine/results.py.
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

bool IsUltralyticsJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence UltralyticsFromJson(const JsonNode& document, double fps);

/// Reads files of one image each from a folder, with these names: frame numbers as in ReadOpenPoseFolder(), broken
/// files and warnings as in ReadJsonFrames(). Throws std::runtime_error naming file and place.
PeopleSequence ReadUltralyticsFolder(const std::string& folder, const std::vector<std::string>& names, double fps,
                                     std::vector<std::string>* warnings = nullptr);

}  // namespace bodyloom
