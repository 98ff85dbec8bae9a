// SPDX-License-Identifier: Apache-2.0
/// Finds a body's triangles by their vertices, independently of their first corner.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "geometry/math/arrays.h"

namespace bodyloom {

class FacesByVertices {
 public:
  explicit FacesByVertices(const MatrixX3i& faces);

  /// Index of the face with exactly these three vertices, the first if there are several; −1 if there is none.
  [[nodiscard]] int Find(const std::array<int, 3>& vertices) const;

 private:
  struct Hash {
    size_t operator()(const std::array<int, 3>& key) const;
  };
  std::unordered_map<std::array<int, 3>, int, Hash> faces_;  // by sorted vertices
};

/// For each corner of `face`, its index in `vertices`: vertices[result[c]] = face[c]. All three must occur.
std::array<int, 3> CornerOrder(const std::array<int, 3>& face, const std::array<int, 3>& vertices);

}  // namespace bodyloom
