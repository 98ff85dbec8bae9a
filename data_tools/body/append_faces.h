// SPDX-License-Identifier: Apache-2.0
/// Adds faces between existing vertices of a body, with part and texture coordinates.
#pragma once

#include "geometry/body/body_model.h"

namespace bodyloom {

/// Appends `faces` (N×3 vertices) to the body's. Each must share an edge with a face of the body, directly or through
/// others of `faces`; the first such face found is its model:
///
///   part               the model's
///   (u, v) of a vertex the model's, where the model has the vertex; otherwise, of those which the vertex has in faces
///                      of the same part, the nearest to the shared edge's, unless it lies further from there than
///                      twice the model's largest UV length a metre allows: then that of the shared edge, so that a
///                      face which would span two islands of the atlas covers no texel
///
/// This holds for texture coordinates (vt by ft) and coordinates inside a chart (face_iuv), if the body has them.
/// Throws std::invalid_argument on an index outside the vertices, a vertex named twice, or a face that adjoins none.
void AppendFaces(const MatrixX3i& faces, BodyModelData* body);

}  // namespace bodyloom
