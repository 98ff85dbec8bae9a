// SPDX-License-Identifier: Apache-2.0
/// PHALP and 4D-Humans: results/demo_NAME.pkl, a joblib pickle, often compressed: frame's path → {tid, tracked_time,
/// time, smpl, camera, size, …}.
///
/// Every value but `time` (number of the frame, from 0) is a list with one entry per track. Entries are read if
/// `tracked_time` is 0: the person was detected in this frame; above 0 PHALP repeats an older pose, −1 marks a filled
/// gap. `tid` is the person; `smpl` {global_orient 1×3×3, body_pose 23×3×3, betas 10}, rotation matrices, one shape per
/// frame, axes of a camera (y down); `camera` 3 metres, the body's translation in the camera below; `size` (height,
/// width) of the image, pixels, in this order.
///
/// PHALP pads the image to a square of S = max(W, H) pixels and scales it to 256, where its focal length is 5000: in
/// the image the focal length is 5000·S/256 (about 20 S: nearly no perspective) and the principal point (W/2, H/2).
/// Source: brjathu/PHALP, phalp/trackers/PHALP.py, phalp/models/hmar; shubham-goel/4D-Humans, track.py.
#pragma once

#include <string>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/pickle.h"

namespace bodyloom {

bool IsPhalp(const PickleValue& file);
/// Throws std::runtime_error naming `where`, frame and key. The image size is used for files without it.
BodyEstimate PhalpFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

}  // namespace bodyloom
