// SPDX-License-Identifier: Apache-2.0
/// VIBE: vibe_output.pkl of demo.py, a joblib pickle: person id → {pose, betas, orig_cam, pred_cam, bboxes, frame_ids, and
/// verts, joints3d, joints2d, which are not read}.
///
/// N frames of a person: `pose` N×72 axis-angle of SMPL, axes of a camera (y down); `betas` N×10, one a frame;
/// `orig_cam` N×4 (sx, sy, tx, ty), a weak perspective of the whole image of W×H pixels:
///   x = W/2 · (1 + sx (X + tx)),   y = H/2 · (1 + sy (Y + ty)),
/// so that a metre has sx·W/2 = sy·H/2 pixels. `pred_cam` is the same in the crop and not needed. `frame_ids` N, of the
/// video, from 0. There is no depth. Source: mkocabas/VIBE, demo.py, lib/utils/demo_utils.py, lib/utils/renderer.py.
#pragma once

#include <string>

#include "bodyloom/data_tools/estimates/body_estimate.h"
#include "bodyloom/data_tools/formats/pickle.h"

namespace bodyloom {

bool IsVibe(const PickleValue& file);
/// Throws std::runtime_error naming `where`, person and key, also when the image size is not known (0) or not the one
/// that orig_cam speaks of.
BodyEstimate VibeFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height);

}  // namespace bodyloom
