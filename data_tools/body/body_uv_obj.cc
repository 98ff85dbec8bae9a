// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>
#include <vector>

#include "bodyloom/data_tools/body/body_faces.h"
#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/formats/obj.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// Corner triples of a polygon: all four of a quad (a body may split it either way), the fan of a larger one.
std::vector<std::array<int, 3>> Triangles(int corners) {
  if (corners == 4) return {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
  std::vector<std::array<int, 3>> triangles;
  for (int k = 2; k < corners; ++k) triangles.push_back({0, k - 1, k});
  return triangles;
}

}  // namespace

void UvFromObj(const std::string& path, BodyModelData* body) {
  const ObjMesh mesh = ReadObj(path);
  const auto fail = [&path](const std::string& message) { throw std::runtime_error(path + ": " + message); };
  if (mesh.positions.rows() != body->v_template.rows()) {
    fail(Concatenate(mesh.positions.rows(), " vertices, expected the body's ", body->v_template.rows(),
                     " in the same order"));
  }
  if (mesh.uv.rows() == 0) fail("no texture coordinates (vt lines)");
  if (mesh.uv.minCoeff() < -1e-3 || mesh.uv.maxCoeff() > 1 + 1e-3) {
    fail(Concatenate("texture coordinates from ", mesh.uv.minCoeff(), " to ", mesh.uv.maxCoeff(), ", expected 0 to 1"));
  }
  const FacesByVertices lookup(body->faces);
  MatrixX3i ft = MatrixX3i::Constant(body->faces.rows(), 3, -1);
  for (int f = 0; f < mesh.num_faces(); ++f) {
    const int begin = mesh.face_begin[f];
    for (const std::array<int, 3>& corners : Triangles(mesh.face_begin[f + 1] - begin)) {
      std::array<int, 3> vertices{}, uv{};
      for (int c = 0; c < 3; ++c) {
        vertices[c] = mesh.corner_position[begin + corners[c]];
        uv[c] = mesh.corner_uv[begin + corners[c]];
      }
      const int face = lookup.Find(vertices);
      if (face < 0) continue;
      if (uv[0] < 0 || uv[1] < 0 || uv[2] < 0) fail(Concatenate("face ", f + 1, " has no texture coordinates"));
      const std::array<int, 3> order =
          CornerOrder({body->faces(face, 0), body->faces(face, 1), body->faces(face, 2)}, vertices);
      for (int c = 0; c < 3; ++c) ft(face, c) = uv[order[c]];
    }
  }
  for (Eigen::Index f = 0; f < ft.rows(); ++f) {
    if (ft(f, 0) < 0) {
      fail(Concatenate("no face with the vertices ", body->faces(f, 0), " ", body->faces(f, 1), " ", body->faces(f, 2),
                       " of the body's face ", f, ", expected a mesh of the same topology"));
    }
  }
  body->vt = mesh.uv.cast<float>().cwiseMax(0.0F).cwiseMin(1.0F);
  body->ft = ft;
}

}  // namespace bodyloom
