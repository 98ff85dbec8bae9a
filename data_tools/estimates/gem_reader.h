// SPDX-License-Identifier: Apache-2.0
/// NVIDIA's GEM (once GENMO): smpl_params.pt of GEM-SMPL's demo_smpl.py, hpe_results.pt of GEM-X's demo_soma.py, zips
/// of torch.save, read without PyTorch (formats/torch_weights.h).
///
/// One person, L frames, all of the video, which is copied frame by frame: `body_params_incam` (or another key that
/// ends in _params_incam, as GEM's own readers take it) {body_pose, global_orient L×3, transl L×3, …}, axis-angle,
/// camera frame (y down), metres; `K_fullimg` L×3×3, the camera, its principal point the middle of the image.
/// `body_params_global`, `net_outputs`, `segment_info` are not read. The columns of body_pose tell the body:
///
///   63       GEM-SMPL: SMPL-X's 21 body joints, with betas L×10; transl as GVHMR's (hmr_readers.h)
///   76·3     GEM-X: the 76 joints of SOMA after its root, the Hips, whose position is transl; its identity and scale
///            parameters are not read
///
/// SOMA's rotations are relative to a T-pose whose joint frames are the world's, as SMPL's are (y up, z forward, x to
/// the person's left): with G(Hips) = R(global_orient) and G(j) = G(parent j) R(pose j), a joint of SMPL turns by
/// G(p)ᵀ G(j) where j and p are the joints of SOMA in its and its parent's place. Joints without a counterpart (Neck2,
/// fingers, face) count by what they carry.
/// Source: NVlabs/GEM-X, docs/DEMO.md, scripts/demo/demo_soma.py; NVlabs/GENMO, README (demo_smpl.py); NVlabs/SOMA-X,
/// soma/geometry/rig_utils.py (apply_joint_orient_local) for the frames; the order of the 77 joints: gem-x's
/// integrations/maya/…/soma77.json.
#pragma once

#include <string>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/weights_file.h"

namespace bodyloom {

/// GVHMR's file has the same form under smpl_params_incam, and is not meant.
bool IsGem(const WeightsFile& file);
/// Throws std::runtime_error naming `where` and the key.
BodyEstimate GemFromTensors(const WeightsFile& file, const std::string& where);

}  // namespace bodyloom
