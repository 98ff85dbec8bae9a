// SPDX-License-Identifier: Apache-2.0
#include "tests/stress/bodies_of_any_size.h"

#include <vector>

#include "tests/support/toy_body.h"

namespace bodyloom::stress {
namespace {

/// Vertices, weights and shape of the toy body's vertices `sources`, in that order; no faces, no correctives.
BodyModelData Picked(const std::vector<int>& sources) {
  const BodyModelData& toy = ToyBody().data();
  BodyModelData d;
  d.name = "toy of " + std::to_string(sources.size());
  d.joint_names = toy.joint_names;
  d.parents = toy.parents;
  const Eigen::Index V = static_cast<Eigen::Index>(sources.size());
  d.v_template.resize(V, 3);
  d.shapedirs.resize(3 * V, toy.shapedirs.cols());
  std::vector<Eigen::Triplet<double>> weights;
  for (Eigen::Index v = 0; v < V; ++v) {
    const int from = sources[v];
    d.v_template.row(v) = toy.v_template.row(from);
    d.shapedirs.middleRows(3 * v, 3) = toy.shapedirs.middleRows(3 * from, 3);
    for (SparseRows::InnerIterator it(toy.weights, from); it; ++it) weights.emplace_back(v, it.col(), it.value());
  }
  d.weights.resize(V, toy.weights.cols());
  d.weights.setFromTriplets(weights.begin(), weights.end());
  return d;
}

}  // namespace

BodyModel BodyOf100Vertices() {
  const BodyModel& toy = ToyBody();
  const int J = toy.num_joints();
  // Three vertices a joint, then the single-vertex landmarks, then any.
  std::vector<int> sources(3 * J, 0);
  for (const Landmark& landmark : toy.data().landmarks) {
    if (landmark.vertices.size() == 1) sources.push_back(landmark.vertices[0]);
  }
  for (int v = 0; sources.size() < 100; v += 40) sources.push_back(v);
  BodyModelData d = Picked(sources);
  std::vector<Eigen::Triplet<double>> weights, regressor;
  for (int v = 3 * J; v < 100; ++v) {
    for (SparseRows::InnerIterator it(d.weights, v); it; ++it) weights.emplace_back(v, it.col(), it.value());
  }
  d.faces.resize(J, 3);
  for (int j = 0; j < J; ++j) {
    const Eigen::RowVector3d corner[3] = {{0.05, 0, 0}, {-0.025, 0.04, 0}, {-0.025, -0.04, 0}};
    for (int c = 0; c < 3; ++c) {
      d.v_template.row(3 * j + c) = toy.joint_template().row(j) + corner[c];
      d.shapedirs.middleRows(3 * (3 * j + c), 3) = toy.joint_shapedirs().middleRows(3 * j, 3).cast<float>();
      weights.emplace_back(3 * j + c, j, 1.0);
      regressor.emplace_back(j, 3 * j + c, 1.0 / 3);
      d.faces(j, c) = 3 * j + c;
    }
  }
  d.weights.setFromTriplets(weights.begin(), weights.end());
  d.J_regressor.resize(J, 100);
  d.J_regressor.setFromTriplets(regressor.begin(), regressor.end());
  int next = 3 * J;
  for (const Landmark& landmark : toy.data().landmarks) {
    if (landmark.vertices.size() == 1) {
      d.landmarks.push_back({landmark.name, {next++}, {1.0}});
      continue;
    }
    // The other landmarks are joints.
    Eigen::RowVector3d at = Eigen::RowVector3d::Zero();
    for (size_t i = 0; i < landmark.vertices.size(); ++i) {
      at += landmark.weights[i] * toy.data().v_template.row(landmark.vertices[i]);
    }
    Eigen::Index j;
    (toy.joint_template().rowwise() - at).rowwise().squaredNorm().minCoeff(&j);
    const int first = static_cast<int>(3 * j);
    d.landmarks.push_back({landmark.name, {first, first + 1, first + 2}, {1.0 / 3, 1.0 / 3, 1.0 / 3}});
  }
  return BodyModel(std::move(d));
}

BodyModel BodyOfManyVertices(int num_vertices) {
  const BodyModelData& toy = ToyBody().data();
  const int V = ToyBody().num_vertices(), copies = num_vertices / V;
  std::vector<int> sources;
  sources.reserve(static_cast<size_t>(num_vertices));
  for (int v = 0; v < num_vertices; ++v) sources.push_back(v % V);
  BodyModelData d = Picked(sources);
  d.J_regressor = toy.J_regressor;
  d.J_regressor.conservativeResize(d.J_regressor.rows(), num_vertices);
  d.landmarks = toy.landmarks;
  const Eigen::Index F = toy.faces.rows();
  d.faces.resize(copies * F, 3);
  for (int copy = 0; copy < copies; ++copy) d.faces.middleRows(copy * F, F) = toy.faces.array() + copy * V;
  return BodyModel(std::move(d));
}

BodyModel ScaledBody(const BodyModel& body, double scale) {
  BodyModelData d = body.data();
  d.v_template *= scale;
  d.shapedirs *= static_cast<float>(scale);
  for (float& x : d.posedirs.block) x *= static_cast<float>(scale);
  return BodyModel(std::move(d));
}

}  // namespace bodyloom::stress
