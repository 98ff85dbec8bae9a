// SPDX-License-Identifier: Apache-2.0
/// Reads BlazePose / MediaPipe landmarks from JSON dumps: a list of frames, each of which is
///   [[x, y, z], …]·33 or [{"x", "y", "z", "visibility", "presence", "name"}, …]·33 (17 entries: COCO),
///   {"nose": {"x", "y", "score"}, …} by landmark name,
///   {"keypoints" or "landmarks" or "pose_landmarks": either list, "score"}, or a list of such objects (several
///   people), null or an empty list when nobody was found.
/// A top-level object with "frames" may hold this list. Beside the list of the body an object may have
/// "left_hand_landmarks", "right_hand_landmarks" and "face_landmarks" (of Holistic), lists of 21, 21 and 468 or 478;
/// all names also as JavaScript writes them ("leftHandLandmarks").
///
/// x and y are pixels or fractions of the image (distinguished by load_detections.h, where the image size is known). z
/// is relative depth and is not used. visibility and presence may be probabilities or logits: when one value of the
/// file lies outside [0, 1], all are logits. Without either, a landmark has confidence 1.
/// Source: MediaPipe pose landmarker docs, tfjs-models pose-detection README.
#pragma once

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

bool IsBlazePoseJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence BlazePoseFromJson(const JsonNode& document, double fps);

}  // namespace bodyloom
