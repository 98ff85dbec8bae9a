// SPDX-License-Identifier: Apache-2.0
/// Triangles of a compact body file: each index as the difference to that of the face `lag` faces before, because
/// meshes are numbered regularly (lag 1: previous triangle; 2: previous quad; 8: the same quad of the previous
/// subdivided face).
#pragma once

#include <cstdint>
#include <string>

#include "bodyloom/data_tools/formats/ndarray.h"
#include "bodyloom/geometry/arrays.h"

namespace bodyloom {

NdArray PackFaces(const MatrixX3i& faces, int lag);

/// The lag of 1, 2 and 8 whose differences deflate best.
int BestLag(const MatrixX3i& faces);

/// The inverse of PackFaces; every index must lie in 0..limit−1 and, when expected_faces >= 0, their number fit. Throws
/// std::runtime_error "where: …".
MatrixX3i UnpackFaces(const NdArray& packed, int lag, int64_t limit, int64_t expected_faces, const std::string& where);

}  // namespace bodyloom
