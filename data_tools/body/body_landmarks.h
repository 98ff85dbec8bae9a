// SPDX-License-Identifier: Apache-2.0
/// Detector keypoints (COCO-17, toes, heels, hands) on SMPL's and SMPL-X's topology, for body files without landmarks.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {

/// Returns the landmarks. Nose, eyes, ears, toes and heels are single vertices; shoulders, elbows, wrists, hips, knees
/// and ankles are the rows of the joint regressor (COCO's hips lie a little further out than SMPL's, which the
/// tracker's fixed offsets compensate). Names as on the built-in body (CocoNames(), then left_big_toe, right_big_toe,
/// left_small_toe, …); bodies with fingers have those of HandLandmarkNames() as well. Empty for bodies with neither
/// 6,890 nor 10,475 vertices, or without SMPL's first 22 joints. Source: vertex numbers from smplx vertex_ids.py.
std::vector<Landmark> StandardLandmarks(const BodyModelData& body);

// Rest pelvis of the published bodies, whose `trans` is the pelvis position minus this.

/// The pelvis joint of the mean neutral shape at rest, metres, about which the root rotates ("smpl", "smplx"). Throws
/// std::invalid_argument for another body. Shapes move it by a few centimetres.
Eigen::Vector3d MeanPelvis(const std::string& body);

}  // namespace bodyloom
