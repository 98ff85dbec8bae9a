// SPDX-License-Identifier: Apache-2.0
/// GVHMR: hmr4d_results.pt of tools/demo/demo.py, a zip of torch.save, read without PyTorch (formats/torch_weights.h).
///
/// One person, L frames, all of the video: `smpl_params_incam` {body_pose L×63, global_orient L×3, transl L×3, betas L×10
/// (one shape a frame)}, axis-angle of SMPL-X's root and 21 body joints (the first 22 of SMPL's 24; hands are 0 here),
/// camera frame (y down), metres; `K_fullimg` L×3×3, the camera: by default the image's centre and a focal length of
/// √(W² + H²). `smpl_params_global` and `net_outputs` are not read. The body is SMPL-X: transl is the place of its
/// pelvis less its own rest pelvis. Source: zju3dv/GVHMR, tools/demo/demo.py.
#pragma once

#include <string>

#include "bodyloom/data_tools/estimates/body_estimate.h"
#include "bodyloom/data_tools/formats/weights_file.h"

namespace bodyloom {

bool IsGvhmr(const WeightsFile& file);
/// Throws std::runtime_error naming `where` and the key.
BodyEstimate GvhmrFromTensors(const WeightsFile& file, const std::string& where);

}  // namespace bodyloom
