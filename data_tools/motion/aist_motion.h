// SPDX-License-Identifier: Apache-2.0
/// AIST++ motions/<seq>.pkl: `smpl_poses` N×72 (or N×24×3) axis-angle, `smpl_trans` N×3, `smpl_scaling` (1).
///
/// Vertices in the data set's world (centimetres, y up) are smpl_scaling · SMPL(θ, β = 0) + smpl_trans, so the motion
/// of a metric SMPL body has trans = smpl_trans / smpl_scaling metres. The person in front of the (metric) cameras is
/// smpl_scaling / 100 times that size. 60 frames a second. Source: google/aistplusplus_api loader.py.
#pragma once

#include <string>

#include "data_tools/formats/pickle.h"
#include "geometry/scene/track.h"

namespace bodyloom {

inline constexpr double kAistFps = 60;  ///< of the recordings; not stated in their files

bool IsAistMotion(const PickleValue& file);
/// Returns smpl_scaling / 100: metres of the world per metre of the body. Throws as below.
double AistBodyScale(const PickleValue& file, const std::string& where);
/// Throws std::runtime_error naming `where`, the key, what it holds and what was expected.
Motion AistMotionFromPickle(const PickleValue& file, const std::string& where, double fps = kAistFps);

}  // namespace bodyloom
