// SPDX-License-Identifier: Apache-2.0
/// Converts the nodes of a garment to bones that drive a person's Gaussians, appended to those of the joints in
/// AvatarFrame.
#pragma once

#include <span>
#include <vector>

#include "geometry/cloth/cloth_nodes.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/avatar_frame.h"

namespace bodyloom {

/// Bones of moved nodes, K × 12: rows of [R_k | p_k − R_k j_k], as AvatarFrame::bones.
std::vector<float> BonesOfCloth(const ClothNodes& nodes, const MovedNodes& moved);

/// Transforms such bones to the frame of `camera`. Throws std::invalid_argument unless their number is a multiple of
/// 12.
std::vector<float> SeenBones(std::span<const float> bones, const CameraPose& camera);

/// Transforms bones of cloth to the frame of `camera` and appends them to `frame`; `as_sewn`: K×3, j_k. Throws
/// std::invalid_argument when sizes differ.
void AppendBones(std::span<const float> bones, const MatrixX3d& as_sewn, const CameraPose& camera, AvatarFrame* frame);

/// Replaces the last bones of a frame by others, already in the camera frame. Throws std::invalid_argument for more
/// bones than it has.
void ReplaceLastBones(std::span<const float> seen, AvatarFrame* frame);

/// Appends to `corrected`, which has joints only, the cloth bones of `frame`, moved rigidly with the root from `frame`
/// to `corrected`.
void CarryBones(const AvatarFrame& frame, AvatarFrame* corrected);

}  // namespace bodyloom
