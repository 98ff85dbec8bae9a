// SPDX-License-Identifier: Apache-2.0
/// VIBE: vibe_output.pkl of demo.py, a joblib pickle: person id → {pose, betas, orig_cam, pred_cam, bboxes, frame_ids,
/// and verts, joints3d, joints2d, which are not read}.
///
/// N frames of a person: `pose` N×72 axis-angle of SMPL, axes of a camera (y down); `betas` N×10, one per frame;
/// `orig_cam` N×4 (sx, sy, tx, ty), a weak perspective of the whole image of W×H pixels:
///   x = W/2 · (1 + sx (X + tx)),   y = H/2 · (1 + sy (Y + ty)),
/// so that a metre has sx·W/2 = sy·H/2 pixels. `pred_cam` is the same in the crop and not needed. `frame_ids` N, of the
/// video, from 0. There is no depth. Source: mkocabas/VIBE, demo.py, lib/utils/demo_utils.py, lib/utils/renderer.py.
#pragma once

#include <string>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/weights_file.h"

namespace bodyloom {

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

}  // namespace bodyloom
