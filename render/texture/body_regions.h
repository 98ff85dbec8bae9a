// SPDX-License-Identifier: Apache-2.0
/// Regions of a body that clothes, hair and colours treat separately: face, scalp, hands and, set by the caller (not by
/// BodyRegions()), a loose garment's vertices, those that it hides, and the shins below.
///
/// hand: vertices whose skinning weights of a wrist and its descendants sum to more than half. The others use the
/// landmarks nose, eyes and ears of COCO-17 at rest (x to the person's left, y up, z to the front); with e and a the
/// midpoints of the eyes and of the ears, n the nose, h = e_y − n_y:
///   head    vertices whose maximum skinning weight is the head's
///   face    of the head, z > a_z + 0.15 (n_z − a_z), y < e_y + 1.4 h
///   scalp   of the head, not face, y > n_y − 0.5 h
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

enum class BodyRegion : uint8_t { kElsewhere, kFace, kScalp, kHand, kGarment, kUnderGarment, kBelowGarment };

/// Region of each vertex, for a body of this rest shape (V×3, metres). A body without the wrist joints has no hands;
/// one without the joint "head" or one of the landmarks has neither face nor scalp.
std::vector<BodyRegion> BodyRegions(const BodyModel& body, const MatrixX3d& rest_vertices);

}  // namespace bodyloom
