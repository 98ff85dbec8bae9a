// SPDX-License-Identifier: Apache-2.0
/// Wavefront OBJ: positions, texture coordinates and polygons. Normals, groups, materials and everything else are
/// ignored.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/math/arrays.h"

namespace bodyloom {

struct ObjMesh {
  MatrixX3d positions;  ///< n×3 (`v`), the file's units
  MatrixX2d uv;         ///< m×2 (`vt`), v up
  /// Polygon f has the corners face_begin[f] .. face_begin[f+1]−1.
  std::vector<int> face_begin;
  std::vector<int> corner_position;  ///< 0-based
  std::vector<int> corner_uv;        ///< 0-based; −1: the corner has none

  [[nodiscard]] int num_faces() const { return static_cast<int>(face_begin.size()) - 1; }
};

/// Throws std::runtime_error "path: line n: what was found, expected what" for invalid or non-finite numbers, indices
/// of 0 or beyond the preceding elements, and faces of fewer than three corners.
ObjMesh ReadObj(const std::string& path);
ObjMesh ReadObjBytes(std::string_view text, const std::string& where);

}  // namespace bodyloom
