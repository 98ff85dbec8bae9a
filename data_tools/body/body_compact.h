// SPDX-License-Identifier: Apache-2.0
/// The compact body file: one .npz of byte planes (body_codec.h), a tenth of the dense form's size and quick to load.
///
/// Members (V vertices, J joints, B shape components, F faces; "packed" = PackIntegers):
///   format        "bodyloom-body-1"                    name, joint_names, landmark_names  text
///   parents       int32 J                              pose_mean   float64 3J, when there is one
///   grid          float64 3: the steps of v_template, shapedirs and posedirs
///   v_template    packed 3V, shapedirs packed 3V·B     residuals of MeshPredictor over the faces
///   faces, ft     packed 3F                            differences to the face `lag` (int32 2) faces before
///   posedirs_*    count per vertex, joint per block, 27 values per block: residuals to the mean of the same joint's
///                 blocks at the vertex's earlier neighbours
///   weights_*, regressor_*, landmark_*                 count, column, weight (PackUnitRows)
///   vt            packed 2U over the mesh of ft        face_part   uint8 F
///   vt_iuv        packed 2U, when in-part coordinates are a function of the UV vertex; else face_iuv packed 6F
/// Grids: v_template 2⁻²¹ m, shapedirs 2⁻²² m, UV 2⁻²⁰, skinning weights 2⁻²¹, regressor and landmarks 2⁻²⁸; posedirs
/// exactly on a decimal grid when the body uses one (the built-in body does: 5·10⁻⁵), else 2⁻²¹.
/// Bound: each coordinate of a posed vertex moves by less than 10⁻⁵ m. In the worst case, Σ|β| = 30 and transforms 1 m
/// apart at one vertex, template, shape, skinning and regressor give 0.3 + 3.6 + 1.9 + 1.5 µm; rounded correctives add
/// 0.24 µm·Σ|R − I| with independent signs, under 3 µm for bodies with all 207 columns in natural poses (tested).
#pragma once

#include <string>

#include "data_tools/body/body_io.h"
#include "data_tools/formats/npz.h"

namespace bodyloom {

bool IsCompactBody(const NpzArrays& arrays);

/// `body` must satisfy BodyModel. Throws std::invalid_argument when a value is too large for its grid.
NpzArrays CompactFromBody(const BodyModelData& body);

/// Throws std::runtime_error "where: …" for contents that CompactFromBody does not write.
BodyModelData BodyFromCompact(const NpzArrays& arrays, const std::string& where, const LoadBodyOptions& options);

}  // namespace bodyloom
