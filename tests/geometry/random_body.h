// SPDX-License-Identifier: Apache-2.0
/// A body of any size with random but plausible arrays: joints about 0.15 m apart, vertices around the bones, at most
/// four influences, shape components of centimetres, correctives of millimetres to centimetres. It has no meaningful
/// surface.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

struct RandomBodyOptions {
  int num_vertices = 300, num_joints = 24, num_betas = 10, num_faces = 100;
  /// Joints that correct a vertex, chosen for each vertex; J−1 or more: all of them, as in SMPL.
  int correctives_per_vertex = 3;
  unsigned seed = 1;
};

/// SMPL's tree first; joints beyond 24 are children of a random earlier joint (like the fingers of SMPL-H and SMPL-X).
inline BodyModelData RandomBodyData(const RandomBodyOptions& o) {
  std::mt19937 random(o.seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto below = [&random](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const int V = o.num_vertices, J = o.num_joints;
  BodyModelData d;
  d.name = "random";
  MatrixX3d anchors(J, 3);
  for (int j = 0; j < J; ++j) {
    d.parents.push_back(j < 24 ? SmplParents()[j] : 12 + below(j - 12));
    anchors.row(j) = 0.1 * Eigen::RowVector3d{normal(random), normal(random), normal(random)};
    if (j > 0) anchors.row(j) += anchors.row(d.parents[j]);
  }
  d.v_template.resize(V, 3);
  std::vector<Eigen::Triplet<double>> weights, regressor;
  for (int v = 0; v < V; ++v) {
    const int main = v % J;
    d.v_template.row(v) = anchors.row(main) + 0.06 * Eigen::RowVector3d{normal(random), normal(random), normal(random)};
    std::vector<int> joints = {main};
    for (int j : {std::max(0, d.parents[main]), below(J), below(J)}) {
      if (below(4) > 0 && std::find(joints.begin(), joints.end(), j) == joints.end()) joints.push_back(j);
    }
    std::vector<double> w(joints.size());
    double sum = 0;
    for (double& x : w) sum += x = 0.05 + below(100);
    for (size_t i = 0; i < joints.size(); ++i) weights.emplace_back(v, joints[i], w[i] / sum);
  }
  for (int j = 0; j < J; ++j) {
    // A few positive weights and one negative, on vertices around the joint.
    const int n = std::min(6, 1 + (V - 1 - j) / J);
    for (int i = 0; i < n; ++i) regressor.emplace_back(j, j + i * J, n == 1 ? 1.0 : i == 0 ? -0.2 : 1.2 / (n - 1));
  }
  d.weights.resize(V, J);
  d.weights.setFromTriplets(weights.begin(), weights.end());
  d.J_regressor.resize(J, V);
  d.J_regressor.setFromTriplets(regressor.begin(), regressor.end());
  d.shapedirs.resize(3 * V, o.num_betas);
  for (Eigen::Index i = 0; i < d.shapedirs.size(); ++i) d.shapedirs.data()[i] = 0.02f * uniform(random);
  if (o.correctives_per_vertex > 0 && J > 1) {
    d.posedirs.begin.push_back(0);
    for (int v = 0; v < V; ++v) {
      std::vector<int> joints;
      for (int j = 1; j < J; ++j) joints.push_back(j);
      if (o.correctives_per_vertex < J - 1) {
        std::shuffle(joints.begin(), joints.end(), random);
        joints.resize(o.correctives_per_vertex);
        std::sort(joints.begin(), joints.end());
      }
      d.posedirs.joint.insert(d.posedirs.joint.end(), joints.begin(), joints.end());
      for (size_t i = 0; i < 27 * joints.size(); ++i) d.posedirs.block.push_back(0.004f * uniform(random));
      d.posedirs.begin.push_back(static_cast<int>(d.posedirs.joint.size()));
    }
  }
  d.faces.resize(o.num_faces, 3);
  for (int f = 0; f < o.num_faces; ++f) {
    const int a = below(V);
    d.faces.row(f) << a, (a + 1 + below(V - 2)) % V, (a + V - 1) % V;
  }
  d.landmarks = {{"nose", {0}, {1.0}}, {"left_eye", {1, 2, 1}, {0.5, 0.7, -0.2}}};
  return d;
}

inline BodyModel RandomBody(const RandomBodyOptions& options = {}) { return BodyModel(RandomBodyData(options)); }

/// Rotations of up to max_angle about random axes and a translation of metres.
inline BodyPose RandomPose(const BodyModel& model, unsigned seed, double max_angle = 2.5) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, max_angle);
  BodyPose pose;
  for (int j = 0; j < model.num_joints(); ++j) {
    const Eigen::Vector3d axis = Eigen::Vector3d{normal(random), normal(random), normal(random)}.normalized();
    pose.rotations.push_back(RotationFromAxisAngle(uniform(random) * axis));
  }
  pose.trans = 2 * Eigen::Vector3d{normal(random), normal(random), normal(random)};
  return pose;
}

inline Eigen::VectorXd RandomBetas(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd betas(n);
  for (int b = 0; b < n; ++b) betas[b] = normal(random);
  return betas;
}

/// The body at rest: every rotation exactly the identity.
inline BodyPose RestPose(const BodyModel& model) {
  BodyPose pose;
  pose.rotations.assign(model.num_joints(), Eigen::Matrix3d::Identity());
  return pose;
}

}  // namespace bodyloom
