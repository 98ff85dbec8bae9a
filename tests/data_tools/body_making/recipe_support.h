// SPDX-License-Identifier: Apache-2.0
/// Measurements of closed triangle meshes for the tests of the built-in body's recipe.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Enclosed volume, m³ (positive for outward faces).
inline double MeshVolume(const MatrixX3d& vertices, const MatrixX3i& faces) {
  double six_volumes = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Eigen::Vector3d a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    six_volumes += a.cross(b).dot(c);
  }
  return six_volumes / 6;
}

inline double MeshArea(const MatrixX3d& vertices, const MatrixX3i& faces) {
  double area = 0;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Eigen::Vector3d a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

/// A third of the area of the faces around each vertex.
inline Eigen::VectorXd VertexAreas(const MatrixX3d& vertices, const MatrixX3i& faces) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(vertices.rows());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Eigen::Vector3d a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    for (int k = 0; k < 3; ++k) areas[faces(f, k)] += (b - a).cross(c - a).norm() / 6;
  }
  return areas;
}

/// Mirror partner of each vertex found by position (x → −x) on a 1 nm grid; −1 where there is none.
inline std::vector<int> MirrorByPosition(const MatrixX3d& vertices) {
  const auto key = [](double x, double y, double z) {
    return std::array<int64_t, 3>{std::llround(1e9 * x), std::llround(1e9 * y), std::llround(1e9 * z)};
  };
  std::map<std::array<int64_t, 3>, int> index_of;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    index_of[key(vertices(v, 0), vertices(v, 1), vertices(v, 2))] = static_cast<int>(v);
  }
  std::vector<int> mirror(vertices.rows(), -1);
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    const auto found = index_of.find(key(-vertices(v, 0), vertices(v, 1), vertices(v, 2)));
    if (found != index_of.end()) mirror[v] = found->second;
  }
  return mirror;
}

/// Index of the joint on the other side, itself in the middle.
inline int MirrorJoint(const BodyModel& body, int joint) {
  std::string name = body.data().joint_names[joint];
  if (name.starts_with("l_")) {
    name[0] = 'r';
  } else if (name.starts_with("r_")) {
    name[0] = 'l';
  }
  return body.FindJoint(name);
}

/// Shape coefficients with one component set.
inline Eigen::VectorXd OneBeta(int component, double value) {
  Eigen::VectorXd betas = Eigen::VectorXd::Zero(10);
  betas[component] = value;
  return betas;
}

}  // namespace bodyloom
