// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body/body_faces.h"

#include <algorithm>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

std::array<int, 3> Sorted(std::array<int, 3> key) {
  std::sort(key.begin(), key.end());
  return key;
}

}  // namespace

size_t FacesByVertices::Hash::operator()(const std::array<int, 3>& key) const {
  uint64_t hash = 0;
  for (const int v : key) hash = (hash ^ static_cast<uint32_t>(v)) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 32);
}

FacesByVertices::FacesByVertices(const MatrixX3i& faces) {
  faces_.reserve(faces.rows());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    faces_.try_emplace(Sorted({faces(f, 0), faces(f, 1), faces(f, 2)}), static_cast<int>(f));
  }
}

int FacesByVertices::Find(const std::array<int, 3>& vertices) const {
  const auto it = faces_.find(Sorted(vertices));
  return it == faces_.end() ? -1 : it->second;
}

std::array<int, 3> CornerOrder(const std::array<int, 3>& face, const std::array<int, 3>& vertices) {
  std::array<int, 3> order{};
  for (int c = 0; c < 3; ++c) {
    const auto it = std::find(vertices.begin(), vertices.end(), face[c]);
    BODYLOOM_CHECK(it != vertices.end(), "vertex ", face[c], " is not a corner of the other triangle");
    order[c] = static_cast<int>(it - vertices.begin());
  }
  return order;
}

}  // namespace bodyloom
