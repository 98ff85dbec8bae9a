// SPDX-License-Identifier: Apache-2.0
/// The nodes of a garment as bones that a person's Gaussians hang on, after those of the joints in AvatarFrame.
#pragma once

#include <span>
#include <vector>

#include "geometry/cloth/cloth_nodes.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/avatar_frame.h"

namespace bodyloom {

/// K × 12: rows of [R_k | p_k − R_k j_k], as AvatarFrame::bones.
std::vector<float> BonesOfCloth(const ClothNodes& nodes, const MovedNodes& moved);

/// Such bones seen by `camera`. Throws std::invalid_argument for a number of values that is no multiple of 12.
std::vector<float> SeenBones(std::span<const float> bones, const CameraPose& camera);

/// Appends bones of cloth, seen by `camera`, to a frame; `as_sewn`: K×3, j_k. Throws std::invalid_argument when sizes
/// differ.
void AppendBones(std::span<const float> bones, const MatrixX3d& as_sewn, const CameraPose& camera, AvatarFrame* frame);

/// Puts others, seen alike, in the place of the last of a frame. Throws std::invalid_argument for more than it has.
void ReplaceLastBones(std::span<const float> seen, AvatarFrame* frame);

/// Appends to `corrected`, which has the joints alone, the bones that `frame` has beyond them: they go with the root,
/// from where it is in `frame` to where it is in `corrected`.
void CarryBones(const AvatarFrame& frame, AvatarFrame* corrected);

}  // namespace bodyloom
