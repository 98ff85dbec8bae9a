// SPDX-License-Identifier: Apache-2.0
/// Offsets of clothes and hair from the bare body, from the mask of one image.
///
/// Measured at the rim: vertices on the body's contour with normals nearly perpendicular to the line of sight. The mask
/// is searched along the projected normal from the edge of the body to the edge of the person: outward over pixels of
/// the person, or inward where the body reaches beyond the person. A search that meets the body again (an arm before
/// the trunk), meets the image's border, or finds no edge within reach gives no measurement.
///
/// Interpolated over the surface as the offsets o that minimise
///   Σ_measured (o_i − m_i)² + s Σ_edges (o_i − o_j)² + Σ_i d_i o_i²
/// with d = `anchor` on the face and hands, which stay bare, and where a loose garment covers the body, and `decay`
/// elsewhere, so that parts far from any measurement stay bare.
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
  double furthest_m = 0.18;  ///< maximum offset; a longer search met something else that the person touches
  double deepest_m = 0.03;   ///< maximum inward offset
  double rim_cosine = 0.35;  ///< maximum cosine between normal and line of sight
  double smoothness = 2;     ///< s
  double decay = 0.002, anchor = 20;
};

struct ClothesOffsets {
  std::vector<double> metres;  ///< one per vertex, along its normal, −deepest_m to furthest_m
  int measured = 0;            ///< rim vertices with a measurement
};

/// `vertices_in_camera`: the bare body in the image's pose. `rest_vertices`: at rest, to locate the face. `covered`,
/// one per vertex: 1 where a loose garment hides the body, which stays bare there; empty: nowhere. Throws
/// std::invalid_argument when the camera has no image size or sizes do not fit.
ClothesOffsets FitClothesOffsets(const BodyModel& body, const MatrixX3d& rest_vertices,
                                 const MatrixX3d& vertices_in_camera, const Camera& camera, const LabelImage& mask,
                                 const ClothesOffsetOptions& options = {}, std::span<const uint8_t> covered = {});

}  // namespace bodyloom
