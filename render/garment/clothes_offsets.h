// SPDX-License-Identifier: Apache-2.0
/// How far clothes and hair stand off a bare body, from the mask of one picture.
///
/// Measured at the rim: a vertex whose normal is nearly square to the line of sight and that lies on the contour of the
/// body. The picture is walked along the projected normal from where the body ends to where the person does: outward
/// over pixels of the person, inward where the body reaches beyond the person. A walk that comes upon the body again
/// (an arm before the trunk), or upon the picture's border, or ends nowhere within reach, measures nothing.
///
/// Spread over the surface as the offsets o that minimise
///   Σ_measured (o_i − m_i)² + s Σ_edges (o_i − o_j)² + Σ_i d_i o_i²
/// with d = `anchor` on the face and hands, whose shape is their own, and on what a loose garment covers, and `decay`
/// elsewhere, so that what nothing was measured near stays bare.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

struct ClothesOffsetOptions {
  double furthest_m = 0.18;  ///< nothing stands off further; a longer walk is something else that the person touches
  double deepest_m = 0.03;   ///< the body is never drawn in by more
  double rim_cosine = 0.35;  ///< of the normal and the line of sight
  double smoothness = 2;     ///< s
  double decay = 0.002, anchor = 20;
};

struct ClothesOffsets {
  std::vector<double> metres;  ///< one a vertex, along its normal, −deepest_m to furthest_m
  int measured = 0;            ///< vertices of the rim with a measurement
};

/// `vertices_in_camera`: the bare body in the picture's pose. `rest_vertices`: at rest, to know the face. `covered`,
/// one a vertex: 1 where a loose garment hides the body, which stays bare there; empty: nowhere. Throws
/// std::invalid_argument when the camera has no image size or sizes do not fit.
ClothesOffsets FitClothesOffsets(const BodyModel& body, const MatrixX3d& rest_vertices,
                                 const MatrixX3d& vertices_in_camera, const Camera& camera, const LabelImage& mask,
                                 const ClothesOffsetOptions& options = {}, std::span<const uint8_t> covered = {});

}  // namespace bodyloom
