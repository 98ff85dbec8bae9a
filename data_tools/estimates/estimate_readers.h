// SPDX-License-Identifier: Apache-2.0
/// Readers of body estimates that other programs write, one per program, which load_estimate.h recognises.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/weights_file.h"

namespace bodyloom {

// NVIDIA's GEM (once GENMO): smpl_params.pt of GEM-SMPL's demo_smpl.py, hpe_results.pt of GEM-X's demo_soma.py, zips
// of torch.save, read without PyTorch (formats/torch_weights.h).
//
// One person, L frames, all of the video, which is copied frame by frame: `body_params_incam` (or another key that
// ends in _params_incam, as GEM's own readers take it) {body_pose, global_orient L×3, transl L×3, …}, axis-angle,
// camera frame (y down), metres; `K_fullimg` L×3×3, the camera, its principal point the middle of the image.
// `body_params_global`, `net_outputs`, `segment_info` are not read. The columns of body_pose tell the body:
//
//   63       GEM-SMPL: SMPL-X's 21 body joints, with betas L×10; transl as GVHMR's (below)
//   76·3     GEM-X: the 76 joints of SOMA after its root, the Hips, whose position is transl; its identity and scale
//            parameters are not read
//
// SOMA's rotations are relative to a T-pose whose joint frames are the world's, as SMPL's are (y up, z forward, x to
// the person's left): with G(Hips) = R(global_orient) and G(j) = G(parent j) R(pose j), a joint of SMPL turns by
// G(p)ᵀ G(j) where j and p are the joints of SOMA in its and its parent's place. Joints without a counterpart (Neck2,
// fingers, face) count by what they carry.
// Source: NVlabs/GEM-X, docs/DEMO.md, scripts/demo/demo_soma.py; NVlabs/GENMO, README (demo_smpl.py); NVlabs/SOMA-X,
// soma/geometry/rig_utils.py (apply_joint_orient_local) for the frames; the order of the 77 joints: gem-x's
// integrations/maya/…/soma77.json.

/// GVHMR's file has the same form under smpl_params_incam, and is not meant.
bool IsGem(const WeightsFile& file);
/// Throws std::runtime_error naming `where` and the key.
BodyEstimate GemFromTensors(const WeightsFile& file, const std::string& where);

// VIBE: vibe_output.pkl of demo.py, a joblib pickle: person id → {pose, betas, orig_cam, pred_cam, bboxes, frame_ids,
// and verts, joints3d, joints2d, which are not read}.
//
// N frames of a person: `pose` N×72 axis-angle of SMPL, axes of a camera (y down); `betas` N×10, one per frame;
// `orig_cam` N×4 (sx, sy, tx, ty), a weak perspective of the whole image of W×H pixels:
//   x = W/2 · (1 + sx (X + tx)),   y = H/2 · (1 + sy (Y + ty)),
// so that a metre has sx·W/2 = sy·H/2 pixels. `pred_cam` is the same in the crop and not needed. `frame_ids` N, of the
// video, from 0. There is no depth. Source: mkocabas/VIBE, demo.py, lib/utils/demo_utils.py, lib/utils/renderer.py.

bool IsVibe(const PickleValue& file);
/// Throws std::runtime_error naming `where`, person and key, also when the image size is not known (0) or not the one
/// that orig_cam implies.
BodyEstimate VibeFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

// WHAM: wham_output.pkl of demo.py --save_pkl, a joblib pickle: person id → {pose, trans, betas, frame_ids, and
// pose_world, trans_world, verts, which are not read}.
//
// N frames of a person: `pose` N×72 axis-angle of SMPL, root in the camera frame (y down); `trans` N×3 metres, such
// that SMPL(pose, betas) + trans lies in the camera frame; `betas` N×10, one per frame; `frame_ids` N, of the video,
// from 0. The camera is not in the file: it is the image's centre (W/2, H/2) and a focal length of √(W² + H²) pixels,
// unless WHAM was run with --calib. Source: yohanshin/WHAM, demo.py and lib/data/datasets/dataset_custom.py.

bool IsWham(const PickleValue& file);
/// Throws std::runtime_error naming `where`, person and key, also when the image size is not known (0).
BodyEstimate WhamFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

// GVHMR: hmr4d_results.pt of tools/demo/demo.py, a zip of torch.save, read without PyTorch (formats/torch_weights.h).
//
// One person, L frames, all of the video: `smpl_params_incam` {body_pose L×63, global_orient L×3, transl L×3, betas
// L×10 (one shape per frame)}, axis-angle of SMPL-X's root and 21 body joints (the first 22 of SMPL's 24; hands are 0
// here), camera frame (y down), metres; `K_fullimg` L×3×3, the camera: by default the image's centre and a focal length
// of √(W² + H²). `smpl_params_global` and `net_outputs` are not read. The body is SMPL-X: transl is the position of its
// pelvis minus its rest pelvis. Source: zju3dv/GVHMR, tools/demo/demo.py.

bool IsGvhmr(const WeightsFile& file);
/// Throws std::runtime_error naming `where` and the key.
BodyEstimate GvhmrFromTensors(const WeightsFile& file, const std::string& where);

// PHALP and 4D-Humans: results/demo_NAME.pkl, a joblib pickle, often compressed: frame's path → {tid, tracked_time,
// time, smpl, camera, size, …}.
//
// Every value but `time` (number of the frame, from 0) is a list with one entry per track. Entries are read if
// `tracked_time` is 0: the person was detected in this frame; above 0 PHALP repeats an older pose, −1 marks a filled
// gap. `tid` is the person; `smpl` {global_orient 1×3×3, body_pose 23×3×3, betas 10}, rotation matrices, one shape per
// frame, axes of a camera (y down); `camera` 3 metres, the body's translation in the camera below; `size` (height,
// width) of the image, pixels, in this order.
//
// PHALP pads the image to a square of S = max(W, H) pixels and scales it to 256, where its focal length is 5000: in
// the image the focal length is 5000·S/256 (about 20 S: nearly no perspective) and the principal point (W/2, H/2).
// Source: brjathu/PHALP, phalp/trackers/PHALP.py, phalp/models/hmar; shubham-goel/4D-Humans, track.py.

bool IsPhalp(const PickleValue& file);
/// Throws std::runtime_error naming `where`, frame and key. The image size is used for files without it.
BodyEstimate PhalpFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

// PromptHMR's video pipeline: results.pkl, a joblib pickle {people, camera, camera_world, masks, …}, of which people
// and camera are read.
//
// `people`: id → {`frames` n, numbers of the loaded frames from 0; `smplx_cam` {`pose` n×75 (or more) or `rotmat`
// n×55×3×3: SMPL-X's root and 21 body joints first; `shape` n×10, one a frame; `trans` n×3 metres}}, camera frame (y
// down). `smplx_world` and 2D keypoints are not read. `camera`: `img_focal`, `img_center` 2, pixels of the loaded
// frames, their middle.
//
// Frames are loaded at 896 pixels of height at most (the width in proportion, to an even number), and of videos above
// 60 frames a second only every second, third, … one. The camera is given in the pixels of the image whose size is
// known, if that has the same proportions to within 1 %; of a thinned video frame numbers do not fit, which the caller
// notices. Source: yufu-wang/PromptHMR, pipeline/pipeline.py, phmr_vid.py, world.py, utils.py.

bool IsPromptHmr(const PickleValue& file);
/// Throws std::runtime_error naming `where`, person and key. Without an image size (0) the camera is in the pixels of
/// the loaded frames.
BodyEstimate PromptHmrFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

// SAM 3D Body: one .npz per person and image with the arrays of a result: `pred_keypoints_3d` 70×3 metres (axes of the
// camera, y down), `pred_keypoints_2d` 70×2 pixels, `pred_cam_t` 3, and, where it was saved, `focal_length`. Or one
// .json per image: the object of a person with these names, or the list of them, as json.dump writes the estimator's
// results.
//
// pred_keypoints_2d is the projection of pred_keypoints_3d + pred_cam_t, to 1e-4 px, not an independent measurement.
// Focal length and principal point follow from the two by least squares; where it is left out, from focal_length and
// the size of the image, which must be known. The 70 are MHR's: 0–8 COCO's face, shoulders and elbows, 9–14 hips,
// knees, ankles, 15 and 18 big toes, 17 and 20 heels, 41 right wrist, 62 left wrist. The body is MHR (18,439 vertices,
// 127 joints), whose pose parameters do not apply to SMPL: its landmarks are read (PersonEstimate::landmarks) and its
// mesh, shape and rotations are not.
//
// A folder of such files is a clip: the frame is the last number in a file's name, before an ending _subjN, _personN
// or _pN that identifies the person ("frame_000012_subj01.npz"); of a list, the place in it does. A lone file is frame
// 0.
//
// SAM3DBody-cpp, the same network in C++, writes what it sees of a video as CSV (--out), from its own field
// keypoints_3d of the same 70 landmarks, without pred_cam_t and the camera: header
// `frame,skeleton_id,nose_x,nose_y,nose_z,…`, frames from 1, skeleton_id the place in the frame's list. Its Python
// front end writes one person's rows without the first two, `nose_3DX,nose_3DY,nose_3DZ,…`, a row for each frame in
// which it saw somebody; all 0: not seen. Where the people are is then not known (BodyEstimate::has_places). Source:
// facebookresearch/sam-3d-body, sam_3d_body/metadata/mhr70.py, sam_3d_body_estimator.py; its files in
// facebookresearch/MHR; AmmarkoV/SAM3DBody-cpp, knowledge/OUTPUT.md, src/core/main.cpp, fast_sam_3dbody_dump_csv.py.

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
