// SPDX-License-Identifier: Apache-2.0
/// The inner loops of geometry/body/normals.h: plain arrays, no Eigen, compiled once per instruction set and chosen at
/// run time (as geometry/body/skinning_simd.h; ForceSimdTarget there applies here too).
///
/// Four values a point or face (x, y, z, w), so that one register holds one; four faces are worked on at a time,
/// turned from rows to columns in registers. No lane depends on another.
#pragma once

#include <cstdint>

namespace bodyloom::normals_internal {

/// Largest |value|; +infinity when a value is not finite.
float LargestMagnitude(const float* values, int64_t count);

/// positions (num_vertices×4) = factor · vertices (×3), w = 0.
void PadVertices(const float* vertices, int num_vertices, float factor, float* positions);

/// Of each face, four values: e1 × e2 and the largest of its |components|; all zero when the face is degenerate.
/// face_vectors has room for four times num_faces rounded up to a multiple of 4. Returns the number of degenerate
/// faces.
int64_t FaceVectors(const float* positions, const int* faces, int num_faces, float* face_vectors);

/// Of each corner (3 a face), four values: angle · unit face normal and the angle; zero for degenerate faces.
/// corner_vectors has room for 12 times num_faces rounded up to a multiple of 4.
int64_t CornerVectors(const float* positions, const int* faces, int num_faces, float* corner_vectors);

/// Sums the vectors at each vertex (entries [begin[v], begin[v+1]) of `items`) and normalises the sum to normals (×3).
/// missing[v] = 1, normal 0, where the sum is within rounding error of zero. Returns the number of those.
int VertexSums(const float* vectors, const int* begin, const int* items, int num_vertices, float* normals,
               uint8_t* missing);

}  // namespace bodyloom::normals_internal
