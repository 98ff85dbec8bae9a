// SPDX-License-Identifier: Apache-2.0
/// COCO keypoints: a results list [{"image_id", "category_id": 1, "keypoints": [x, y, c]·17, "score"}] as from most
/// detectors and AlphaPose, or an annotation table {"images": […], "annotations": […]}.
///
/// image_id is a number or a file name; its number is the frame. Several entries with one image_id are several people.
/// AlphaPose's "idx" and PoseTrack's "track_id" are identities. Confidences above 1 (AlphaPose) count as 1; in
/// annotations the third value is a flag: 0 missing, 1 labelled but hidden (confidence 0.5), 2 visible (confidence 1).
/// 17, 23, 26, 133 (COCO-WholeBody) and 136 (Halpe) landmarks are read; the last 110 of 133 and 136, or the keys
/// lefthand_kpts, righthand_kpts and face_kpts of COCO-WholeBody's annotations, are the person's hands and face.
/// Source: cocodataset.org/#format-data, AlphaPose, "Output format".
#pragma once

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

bool IsCocoJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence CocoFromJson(const JsonNode& document, double fps);

}  // namespace bodyloom
