// SPDX-License-Identifier: Apache-2.0
/// PromptHMR's video pipeline: results.pkl, a joblib pickle {people, camera, camera_world, masks, …}, of which people
/// and camera are read.
///
/// `people`: id → {`frames` n, numbers of the loaded frames from 0; `smplx_cam` {`pose` n×75 (or more) or `rotmat`
/// n×55×3×3: SMPL-X's root and 21 body joints first; `shape` n×10, one a frame; `trans` n×3 metres}}, camera frame (y
/// down). `smplx_world` and 2D keypoints are not read. `camera`: `img_focal`, `img_center` 2, pixels of the loaded
/// frames, their middle.
///
/// Frames are loaded at 896 pixels of height at most (the width in proportion, to an even number), and of videos above
/// 60 frames a second only every second, third, … one. The camera is given in the pixels of the image whose size is
/// known, if that has the same proportions to within 1 %; of a thinned video frame numbers do not fit, which the caller
/// notices. Source: yufu-wang/PromptHMR, pipeline/pipeline.py, phmr_vid.py, world.py, utils.py.
#pragma once

#include <string>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/pickle.h"

namespace bodyloom {

bool IsPromptHmr(const PickleValue& file);
/// Throws std::runtime_error naming `where`, person and key. Without an image size (0) the camera is in the pixels of
/// the loaded frames.
BodyEstimate PromptHmrFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

}  // namespace bodyloom
