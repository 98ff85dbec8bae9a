// SPDX-License-Identifier: Apache-2.0
/// Closed meshes by formula for tests of normals and of UV maps.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

struct TestMesh {
  MatrixX3d vertices;
  MatrixX3i faces;
};

/// The unit sphere: an icosahedron whose faces are split in four `levels` times.
inline TestMesh UnitSphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Eigen::Vector3d> points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Eigen::Vector3i> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) points.push_back(0.5 * (points[a] + points[b]));
      return entry->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& f : faces) {
      const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    faces.swap(finer);
  }
  TestMesh mesh{MatrixX3d(points.size(), 3), MatrixX3i(faces.size(), 3)};
  for (size_t i = 0; i < points.size(); ++i) mesh.vertices.row(i) = points[i].normalized().transpose();
  for (size_t i = 0; i < faces.size(); ++i) mesh.faces.row(i) = faces[i].transpose();
  return mesh;
}

/// A body of one joint at the mean of the mesh, with the mesh's UVs: vt and ft as in BodyModelData.
inline BodyModelData BodyOfMesh(const TestMesh& mesh, const MatrixX2f& vt, const MatrixX3i& ft) {
  BodyModelData d;
  const Eigen::Index V = mesh.vertices.rows();
  d.name = "mesh";
  d.joint_names = {"root"};
  d.parents = {-1};
  d.v_template = mesh.vertices;
  d.shapedirs.resize(3 * V, 0);
  std::vector<Eigen::Triplet<double>> regressor, weights;
  for (Eigen::Index v = 0; v < V; ++v) {
    regressor.emplace_back(0, v, 1.0 / static_cast<double>(V));
    weights.emplace_back(v, 0, 1.0);
  }
  d.J_regressor.resize(1, V);
  d.J_regressor.setFromTriplets(regressor.begin(), regressor.end());
  d.weights.resize(V, 1);
  d.weights.setFromTriplets(weights.begin(), weights.end());
  d.faces = mesh.faces;
  d.vt = vt;
  d.ft = ft;
  return d;
}

/// The unit sphere from an octahedron whose faces are split in four `levels` times, each octant a triangular chart of
/// its own in an atlas of 4×2 cells, `margin` of a cell away from the cell's boundary. Octant i holds the points with
/// signs (i & 1, i & 2, i & 4: negative); odd ones are mirrored in UV, as charts of real bodies are.
inline BodyModelData SphereOfOctants(int levels, double margin = 0.1) {
  TestMesh mesh;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> faces, face_uv;
  std::vector<Eigen::Vector2f> uvs;
  std::map<std::array<long, 3>, int> point_ids;
  const int n = 1 << levels;
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3d sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    std::map<std::pair<int, int>, int> uv_ids;
    const auto corner = [&](int i, int j, Eigen::Vector3i* face, Eigen::Vector3i* uv, int k) {
      const Eigen::Vector3d flat = Eigen::Vector3d(i, j, n - i - j) / n;
      const Eigen::Vector3d p = sign.cwiseProduct(flat).normalized();
      const std::array<long, 3> key = {std::lround(1e6 * p[0]), std::lround(1e6 * p[1]), std::lround(1e6 * p[2])};
      const auto [point, is_new] = point_ids.try_emplace(key, static_cast<int>(points.size()));
      if (is_new) points.push_back(p);
      const auto [entry, is_new_uv] = uv_ids.try_emplace({i, j}, static_cast<int>(uvs.size()));
      if (is_new_uv) {
        const double x = margin + (1 - 2 * margin) * flat[0], y = margin + (1 - 2 * margin) * flat[1];
        uvs.emplace_back(static_cast<float>((octant % 4 + x) / 4), static_cast<float>((octant / 4 + y) / 2));
      }
      (*face)[k] = point->second;
      (*uv)[k] = entry->second;
    };
    const auto add = [&](int i0, int j0, int i1, int j1, int i2, int j2) {
      Eigen::Vector3i face, uv;
      corner(i0, j0, &face, &uv, 0);
      corner(i1, j1, &face, &uv, 1);
      corner(i2, j2, &face, &uv, 2);
      if (sign.prod() < 0) {
        std::swap(face[1], face[2]);
        std::swap(uv[1], uv[2]);
      }
      faces.push_back(face);
      face_uv.push_back(uv);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        add(i, j, i + 1, j, i, j + 1);
        if (i + j + 1 < n) add(i + 1, j, i + 1, j + 1, i, j + 1);
      }
    }
  }
  mesh.vertices.resize(points.size(), 3);
  mesh.faces.resize(faces.size(), 3);
  MatrixX2f vt(uvs.size(), 2);
  MatrixX3i ft(faces.size(), 3);
  for (size_t i = 0; i < points.size(); ++i) mesh.vertices.row(i) = points[i].transpose();
  for (size_t i = 0; i < uvs.size(); ++i) vt.row(i) = uvs[i].transpose();
  for (size_t i = 0; i < faces.size(); ++i) {
    mesh.faces.row(i) = faces[i].transpose();
    ft.row(i) = face_uv[i].transpose();
  }
  return BodyOfMesh(mesh, vt, ft);
}

}  // namespace bodyloom
