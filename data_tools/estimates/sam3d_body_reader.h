// SPDX-License-Identifier: Apache-2.0
/// SAM 3D Body: one .npz per person and image with the arrays of a result: `pred_keypoints_3d` 70×3 metres (axes of the
/// camera, y down), `pred_keypoints_2d` 70×2 pixels, `pred_cam_t` 3, and, where it was saved, `focal_length`. Or one
/// .json per image: the object of a person with these names, or the list of them, as json.dump writes the estimator's
/// results.
///
/// pred_keypoints_2d is the projection of pred_keypoints_3d + pred_cam_t, to 1e-4 px, not an independent measurement.
/// Focal length and principal point follow from the two by least squares; where it is left out, from focal_length and
/// the size of the image, which must be known. The 70 are MHR's: 0–8 COCO's face, shoulders and elbows, 9–14 hips,
/// knees, ankles, 15 and 18 big toes, 17 and 20 heels, 41 right wrist, 62 left wrist. The body is MHR (18,439 vertices,
/// 127 joints), whose pose parameters do not apply to SMPL: its landmarks are read (PersonEstimate::landmarks) and its
/// mesh, shape and rotations are not.
///
/// A folder of such files is a clip: the frame is the last number in a file's name, before an ending _subjN, _personN
/// or _pN that identifies the person ("frame_000012_subj01.npz"); of a list, the place in it does. A lone file is frame
/// 0.
///
/// SAM3DBody-cpp, the same network in C++, writes what it sees of a video as CSV (--out), from its own field
/// keypoints_3d of the same 70 landmarks, without pred_cam_t and the camera: header
/// `frame,skeleton_id,nose_x,nose_y,nose_z,…`, frames from 1, skeleton_id the place in the frame's list. Its Python
/// front end writes one person's rows without the first two, `nose_3DX,nose_3DY,nose_3DZ,…`, a row for each frame in
/// which it saw somebody; all 0: not seen. Where the people are is then not known (BodyEstimate::has_places). Source:
/// facebookresearch/sam-3d-body, sam_3d_body/metadata/mhr70.py, sam_3d_body_estimator.py; its files in
/// facebookresearch/MHR; AmmarkoV/SAM3DBody-cpp, knowledge/OUTPUT.md, src/core/main.cpp, fast_sam_3dbody_dump_csv.py.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"

namespace bodyloom {

bool IsSam3dBody(const NpzArrays& arrays);
/// Throws std::runtime_error naming `where` and the key. The image size (0: not known) is for results without
/// pred_keypoints_2d.
BodyEstimate Sam3dBodyFromNpz(const NpzArrays& arrays, const std::string& where, int image_width, int image_height);

bool IsSam3dBody(const JsonNode& document);
/// The same for the people of one image.
BodyEstimate Sam3dBodyFromJson(const JsonNode& document, int image_width, int image_height);

bool IsSam3dBodyCsv(std::string_view text);
/// Throws std::runtime_error naming `where` and the line.
BodyEstimate Sam3dBodyFromCsv(std::string_view text, const std::string& where);

/// Throws std::runtime_error naming the folder or the file in it.
BodyEstimate ReadSam3dBodyFolder(const std::string& folder, int image_width, int image_height);

}  // namespace bodyloom
