// SPDX-License-Identifier: Apache-2.0
/// WHAM: wham_output.pkl of demo.py --save_pkl, a joblib pickle: person id → {pose, trans, betas, frame_ids, and
/// pose_world, trans_world, verts, which are not read}.
///
/// N frames of a person: `pose` N×72 axis-angle of SMPL, root in the camera frame (y down); `trans` N×3 metres, such
/// that SMPL(pose, betas) + trans lies in the camera frame; `betas` N×10, one a frame; `frame_ids` N, of the video,
/// from 0. The camera is not in the file: it is the image's centre (W/2, H/2) and a focal length of √(W² + H²) pixels,
/// unless WHAM was run with --calib. Source: yohanshin/WHAM, demo.py and lib/data/datasets/dataset_custom.py.
#pragma once

#include <string>

#include "bodyloom/data_tools/estimates/body_estimate.h"
#include "bodyloom/data_tools/formats/pickle.h"

namespace bodyloom {

bool IsWham(const PickleValue& file);
/// Throws std::runtime_error naming `where`, person and key, also when the image size is not known (0).
BodyEstimate WhamFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

}  // namespace bodyloom
