// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/geometry/bake_shape.h"

#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/vertex_normals.h"

namespace bodyloom {
namespace {

constexpr double kLargestWeight = 1.5;

/// The change of `weights` of these vertices (rows of `positions`) after which they give `point`, as nearly as no large
/// weights can.
Eigen::VectorXd ChangeOfWeights(const MatrixX3d& positions, const Eigen::VectorXd& weights,
                                const Eigen::Vector3d& point) {
  // Combinations of centred positions sum to zero.
  const Eigen::MatrixXd conditions = (positions.rowwise() - positions.colwise().mean()).transpose();
  const Eigen::Vector3d wanted = point - positions.transpose() * weights;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  for (const double flat : {1e-6, 1e-3, 1e-2, 0.1, 0.5}) {
    solver.setThreshold(flat);
    solver.compute(conditions);
    Eigen::VectorXd change = solver.solve(wanted);
    if ((weights + change).cwiseAbs().maxCoeff() <= kLargestWeight) return change;
  }
  return Eigen::VectorXd::Zero(weights.size());
}

}  // namespace

BodyModelData BakeShape(const BodyModel& body, const Eigen::VectorXd& betas, std::span<const double> offsets_m) {
  const int num_vertices = body.num_vertices();
  BODYLOOM_CHECK(offsets_m.empty() || static_cast<int>(offsets_m.size()) == num_vertices, offsets_m.size(),
                 " offsets, expected one for each of ", num_vertices, " vertices");
  const MatrixX3d bare = ShapeVertices(body, betas);
  BodyModelData data = body.data();
  data.v_template = bare;
  if (!offsets_m.empty()) {
    const MatrixX3f normals = VertexNormals(bare, data.faces);
    for (int v = 0; v < num_vertices; ++v) {
      BODYLOOM_CHECK(std::isfinite(offsets_m[v]), "offset of vertex ", v, " is not finite");
      data.v_template.row(v) += offsets_m[v] * normals.row(v).cast<double>();
    }
  }

  const MatrixX3d joints = body.RestJoints(betas);
  for (int j = 0; j < body.num_joints(); ++j) {
    std::vector<int> vertices;
    for (SparseRows::InnerIterator it(data.J_regressor, j); it; ++it) vertices.push_back(static_cast<int>(it.col()));
    const MatrixX3d positions = data.v_template(vertices, Eigen::all);
    Eigen::VectorXd weights(static_cast<int>(vertices.size()));
    int k = 0;
    for (SparseRows::InnerIterator it(data.J_regressor, j); it; ++it) weights[k++] = it.value();
    weights += ChangeOfWeights(positions, weights, joints.row(j).transpose());
    k = 0;
    for (SparseRows::InnerIterator it(data.J_regressor, j); it; ++it) it.valueRef() = weights[k++];
  }
  for (Landmark& landmark : data.landmarks) {
    const MatrixX3d positions = data.v_template(landmark.vertices, Eigen::all);
    Eigen::Map<Eigen::VectorXd> weights(landmark.weights.data(), static_cast<int>(landmark.weights.size()));
    const Eigen::Vector3d point = bare(landmark.vertices, Eigen::all).transpose() * weights;
    weights += ChangeOfWeights(positions, weights, point);
  }
  return data;
}

Track OfBakedBody(Track track) {
  track.motion.betas.setZero();
  track.joints.clear();
  return track;
}

}  // namespace bodyloom
