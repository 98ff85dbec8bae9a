// SPDX-License-Identifier: Apache-2.0
/// Finds a body's triangles by their vertices, whatever corner a file starts them at.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "geometry/math/arrays.h"

namespace bodyloom {

class FacesByVertices {
 public:
  explicit FacesByVertices(const MatrixX3i& faces);

  /// The face with exactly these three vertices, −1 when there is none. When two faces share all three, the first.
  [[nodiscard]] int Find(const std::array<int, 3>& vertices) const;

 private:
  struct Hash {
    size_t operator()(const std::array<int, 3>& key) const;
  };
  std::unordered_map<std::array<int, 3>, int, Hash> faces_;  // by sorted vertices
};

/// Which of `vertices` stands at each corner of `face`: vertices[result[c]] = face[c]. All three must occur.
std::array<int, 3> CornerOrder(const std::array<int, 3>& face, const std::array<int, 3>& vertices);

}  // namespace bodyloom
