// SPDX-License-Identifier: Apache-2.0
/// Joins a body and its loose garment into one body model, to be rendered, textured and exported like any other.
///
/// The garment's vertices (LooseGarment::drawn_from, as sewn) and faces follow the body's. In UV the body's charts keep
/// their width and shrink to kBodyShareOfV of the height; above them the garment is one rectangle, its circumference
/// along u, the pinned ring at the top. Without cloth simulation the garment follows the nearby limbs: from the body's
/// vertices b of trunk and legs with skinning weights w_b on the joints 0 to 11, normalised to 1,
///   w(v) = Σ_b exp(−‖v − b‖² / 2σ²) w_b / Σ_b exp(−‖v − b‖² / 2σ²),   σ = 0.1 m.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

constexpr double kBodyShareOfV = 0.8;

/// `garment` was cut for this body. It has no shape components, correctives, landmarks or parts. Throws
/// std::invalid_argument when the body does not begin with SMPL's 24 joints.
BodyModelData BodyWithGarment(const BodyModel& body, const LooseGarment& garment);

/// Extracts the body, whose vertices are the first `num_vertices` of `both`. Throws std::invalid_argument when one of
/// its faces or regressors refers to a later vertex, or there are fewer vertices.
BodyModelData BodyWithoutGarment(const BodyModel& both, int num_vertices);

/// Writes the cloth's vertices (from ClothRun) into the last rows of the vertices of both.
void PlaceGarment(const LooseGarment& garment, std::span<const Eigen::Vector3d> cloth, MatrixX3d* vertices_of_both);

}  // namespace bodyloom
