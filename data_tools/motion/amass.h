// SPDX-License-Identifier: Apache-2.0
/// AMASS motions (.npz): `poses` T×156 (SMPL-H), 165 or 162 (SMPL-X) or 72 (SMPL) axis-angle, `trans` T×3 metres,
/// `betas`, `gender`, and the frame rate as `mocap_framerate` or, in the SMPL-X release, `mocap_frame_rate`. z up.
/// Files that were written again may have `poses` T×J×3, the rate as `fps`, and `betas` T×B; in place of `poses`,
/// `root_orient` T×3 and `pose_body` T×63.
///
/// Columns 0–2 are the root, 3–65 SMPL's 21 body joints in every family; hands, jaw and eyes are left out and SMPL's
/// two hand joints are zero. A file may deviate from AMASS: `timestamps` (T seconds) override the frame rate, `up_axis`
/// is "y" or "z", and `camera_model` marks a track in camera coordinates. Source: amass.is.tue.mpg.de, headers of the
/// released files.
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/npz.h"
#include "geometry/scene/track.h"

namespace bodyloom {

bool IsAmass(const NpzArrays& arrays);
/// Returns a motion of SMPL's 24 joints. If each frame has a shape of its own, its betas are their mean, and
/// `warnings`, when requested, gets a line. Throws std::runtime_error naming `where`, the key, what it holds and what
/// was expected.
Motion AmassFromNpz(const NpzArrays& arrays, const std::string& where, std::vector<std::string>* warnings = nullptr);

/// Writes the SMPL-H form (156 columns, z up) of a motion of 24, 52 or 55 joints, SMPL-X's jaw and eyes left out; hands
/// count from the template's. `rest_pelvis` is the body's pelvis joint at rest, about which it turns. `timestamps`
/// are written too. `betas` are the motion's if its body is SMPL or SMPL-H, which share them; otherwise 16 zeros, with
/// `trans` set for the same pelvis on the mean neutral shape, and the body's own name and shape are in `source_body`
/// and `source_betas`. Throws std::invalid_argument for an invalid motion.
void WriteAmass(const std::string& path, const Motion& motion, const Eigen::Vector3d& rest_pelvis,
                const std::string& gender = "neutral");

/// Writes the SMPL-X form, for GMR (retargeting to robots) and other readers of AMASS' second release: `poses` T×165
/// and the same in parts (`root_orient`, `pose_body` T×63, `pose_jaw`, `pose_eye`, `pose_hand` T×90), `trans`, 16
/// `betas`, `gender` text, `surface_model_type` 'smplx', the frame rate under both spellings; z up. Motions of 24, 52
/// or 55 joints; SMPL's two hand joints are left out. `betas` are the motion's if its body is SMPL-X, otherwise 0, with
/// `trans` set for the same pelvis on SMPL-X's mean neutral shape, and `source_body` and `source_betas`. Throws as
/// WriteAmass().
void WriteAmassSmplx(const std::string& path, const Motion& motion, const Eigen::Vector3d& rest_pelvis,
                     const std::string& gender = "neutral");

}  // namespace bodyloom
