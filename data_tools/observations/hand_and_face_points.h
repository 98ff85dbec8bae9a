// SPDX-License-Identifier: Apache-2.0
/// Makes hands and faces (geometry/scene/hands_and_face.h) of the lists of points that detectors' files hold beside
/// those of the body.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "geometry/scene/hands_and_face.h"

namespace bodyloom {

/// Points of each part, none where a file has none of it. A hand has 21; a face 68 (300-W), 70 (OpenPose: and the
/// pupils, which are left out), 468 or 478 (MediaPipe, of which 68 are kept).
struct HandAndFacePoints {
  std::vector<Keypoint> left_hand, right_hand, face;
};

/// Parts of which no point was seen are absent; null when that leaves none. Confidences are limited to 1. Throws
/// std::runtime_error "place: …" for another number of points.
std::shared_ptr<const HandsAndFace> HandsAndFaceFrom(const HandAndFacePoints& points, const std::string& place);

/// Of the points of a whole body in COCO's family (133 of COCO-WholeBody, 136 of Halpe): behind the body's `num_body`
/// those of the face (68), the left and the right hand. Null for another number of points.
std::shared_ptr<const HandsAndFace> HandsAndFaceOfWholeBody(std::span<const Keypoint> all, size_t num_body,
                                                            const std::string& place);

/// Changes each frame's hands and face by change(&frame).
void ChangeHandsAndFaces(const std::function<void(HandsAndFace*)>& change, HandsAndFaceSequence* sequence);

/// A table's list of numbers x, y, confidence, …; none without the key, for null and for an empty list. Throws
/// std::runtime_error "place: …" for a number of numbers that is no multiple of three.
std::vector<Keypoint> PointsAtKey(const JsonNode& table, const char* key);

}  // namespace bodyloom
