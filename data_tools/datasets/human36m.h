// SPDX-License-Identifier: Apache-2.0
/// True motions of Human3.6M in the forms in which its owners pass them on, 50 frames a second, in the world of its
/// cameras (data_tools/observations/load_cameras.h, form 4):
///
///   Human36M_subject*_joint_3d.json     action → subaction → frame → 17×3 mm
///   Human36M_subject*_smpl_param.json   the same with {pose 72 axis-angle, shape 10, trans 3 metres} of neutral SMPL,
///                                       fitted to every fifth frame
///   data_3d_h36m.npz                    positions_3d, a pickled table: subject → action → frames × 32 × 3 metres
///
/// Actions are numbers from 2 ("2" Directions, "3" Discussion, … "16" WalkTogether), subactions "1", "2". The 17 are
/// the joints 0–3, 6–8, 12–15, 17–19, 25–27 of the 32, in the order of Human36m17() (keypoint_conventions.h). Source:
/// mks0601/3DMPPE_POSENET_RELEASE, tool/Human36M/h36m2coco.py, data/Human36M/Human36M.py; mks0601's I2L-MeshNet for the
/// SMPL fits; facebookresearch/VideoPose3D, data/prepare_data_h36m.py, common/h36m_dataset.py.
#pragma once

#include <string>
#include <vector>

#include "data_tools/datasets/video_truth.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

inline constexpr double kHuman36mFps = 50;

struct Human36mClip {
  std::string sequence;
  std::vector<MatrixX3d> joints;  ///< T of 17×3 metres in the world; without rows where they are not told
};

/// Returns true for data_3d_h36m.npz.
bool IsHuman36mPositions(const NpzArrays& arrays);

/// `sequence`: "SUBJECT/ACTION" as in the file ("S9/Directions 1"). Throws std::runtime_error naming `where`, what was
/// found and, for a missing sequence, those present.
Human36mClip Human36mFromPositions(const PickleValue& positions_3d, const std::string& sequence,
                                   const std::string& where);

/// Returns true if the entries of frames are SMPL's parameters, not joints.
bool HasHuman36mSmpl(const JsonNode& document);

/// `sequence`: "ACTION/SUBACTION" ("2/1", or "Directions/1"). Throws as above.
Human36mClip Human36mFromJson(const JsonNode& document, const std::string& sequence);

/// SMPL's motion in the world, with `camera` standing still in it. Frames without a fit are lost, also the four after
/// the last one.
VideoTruth Human36mSmplFromJson(const JsonNode& document, const std::string& sequence, const NamedCamera& camera);

}  // namespace bodyloom
