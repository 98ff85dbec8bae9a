// SPDX-License-Identifier: Apache-2.0
/// Reads MMPose's JSON. A person is {"keypoints": [[x, y], …], "keypoint_scores": […], "bbox": …, "bbox_score": …},
/// pixels.
///
/// Three forms: a list of people (one image; a folder has one such file per image), a list of {"frame_id": n,
/// "instances": [people]} with n from 0 (the inferencer on a video), and {"meta_info": {…}, "instance_info":
/// [{"frame_id": n, "instances": […]}]} with n from 1 (the demo scripts). There is no identity. Scores may exceed 1
/// slightly and count as 1. 17 (COCO), 23, 26 (Halpe, Body8), 133 (COCO-WholeBody) and 136 landmarks are read;
/// `meta_info`, if present, identifies them, and an order of other landmarks is refused. Lifted keypoints [x, y, z] are
/// refused, as they are not pixels.
/// Source: open-mmlab/mmpose, mmpose/structures/utils.py, mmpose/apis/inferencers, demo/topdown_demo_with_mmdet.py.
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "data_tools/observations/people.h"

namespace bodyloom {

bool IsMmposeJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence MmposeFromJson(const JsonNode& document, double fps);

/// Reads files of one image each from a folder, with these names: frame numbers as in ReadOpenPoseFolder(), broken
/// files and warnings as in ReadJsonFrames(). Throws std::runtime_error naming file and place.
PeopleSequence ReadMmposeFolder(const std::string& folder, const std::vector<std::string>& names, double fps,
                                std::vector<std::string>* warnings = nullptr);

}  // namespace bodyloom
