// SPDX-License-Identifier: Apache-2.0
/// SAM 3D Body: one .npz per person and image with the arrays of a result: `pred_keypoints_3d` 70×3 metres (axes of the
/// camera, y down), `pred_keypoints_2d` 70×2 pixels, `pred_cam_t` 3, and, where it was saved, `focal_length`.
///
/// pred_keypoints_2d is the projection of pred_keypoints_3d + pred_cam_t, to 1e-4 px, not an independent measurement.
/// Focal length and principal point follow from the two by least squares, so focal_length is not needed. The 70 are
/// MHR's: 0–8 COCO's face, shoulders and elbows, 9–14 hips, knees, ankles, 15 and 18 big toes, 17 and 20 heels, 41
/// right wrist, 62 left wrist. The body is MHR (18,439 vertices, 127 joints), whose pose parameters do not apply to
/// SMPL: its landmarks are read (PersonEstimate::landmarks) and its mesh, shape and rotations are not.
///
/// A folder of such files is a clip: the frame is the last number in a file's name, before an ending _subjN, _personN
/// or _pN that identifies the person ("frame_000012_subj01.npz"). A lone file is frame 0.
/// Source: facebookresearch/sam-3d-body, sam_3d_body/metadata/mhr70.py, sam_3d_body_estimator.py; its files in
/// facebookresearch/MHR.
#pragma once

#include <string>
#include <vector>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/npz.h"

namespace bodyloom {

bool IsSam3dBody(const NpzArrays& arrays);
/// Throws std::runtime_error naming `where` and the key.
BodyEstimate Sam3dBodyFromNpz(const NpzArrays& arrays, const std::string& where);
/// Throws std::runtime_error naming the folder or the file in it.
BodyEstimate ReadSam3dBodyFolder(const std::string& folder);

}  // namespace bodyloom
