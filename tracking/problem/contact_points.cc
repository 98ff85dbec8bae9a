// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/contact_points.h"

#include <algorithm>
#include <string>

namespace bodyloom {

using Eigen::Vector3d;

namespace {

constexpr int kMinVertices = 4;
constexpr double kSoleM = 0.015;

/// The joint with the largest weight of each vertex.
std::vector<int> LeadingJoints(const BodyModel& model) {
  std::vector<int> leading(model.num_vertices(), 0);
  for (int v = 0; v < model.num_vertices(); ++v) {
    double most = -1;
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      if (model.influence_weight()[k] <= most) continue;
      most = model.influence_weight()[k];
      leading[v] = model.influence_joint()[k];
    }
  }
  return leading;
}

int LegOf(const std::string& joint) {
  for (const char* part : {"hip", "knee", "ankle", "foot"}) {
    if (joint == std::string("l_") + part) return 0;
    if (joint == std::string("r_") + part) return 1;
  }
  return -1;
}

bool HasSole(const std::string& joint) {
  return joint == "l_ankle" || joint == "r_ankle" || joint == "l_foot" || joint == "r_foot";
}

}  // namespace

std::vector<ContactPoint> FindContactPoints(const BodyModel& model) {
  const std::vector<int> leading = LeadingJoints(model);
  const auto& rest = model.data().v_template;
  const double lowest = rest.col(1).minCoeff();
  std::vector<ContactPoint> points;
  for (int j = 0; j < model.num_joints(); ++j) {
    std::vector<int> own;
    for (int v = 0; v < model.num_vertices(); ++v) {
      if (leading[v] == j) own.push_back(v);
    }
    if (static_cast<int>(own.size()) < kMinVertices) continue;
    std::vector<Vector3d> directions;
    const std::string& joint = model.data().joint_names[j];
    const int leg = LegOf(joint);
    if (HasSole(joint)) {
      // Heels are led by ankles, balls and toes by feet.
      const double z = joint.ends_with("foot") ? 1 : -1;
      for (const double x : {-1.0, 1.0}) directions.emplace_back(0.5 * x, -1, 0.5 * z);
      directions.emplace_back(0, 0, z);
      directions.push_back(Vector3d::UnitY());
    } else {
      for (int axis = 0; axis < 3; ++axis) {
        directions.push_back(Vector3d::Unit(axis));
        directions.push_back(-Vector3d::Unit(axis));
      }
    }
    for (const Vector3d& direction : directions) {
      const int farthest = *std::max_element(own.begin(), own.end(), [&](int a, int b) {
        return rest.row(a).dot(direction.transpose()) < rest.row(b).dot(direction.transpose());
      });
      const bool sole = HasSole(joint) && rest(farthest, 1) <= lowest + kSoleM;
      points.push_back({farthest, j, leg, sole, sole ? rest(farthest, 1) - lowest : 0});
    }
  }
  const auto before = [](const ContactPoint& a, const ContactPoint& b) { return a.vertex < b.vertex; };
  const auto same = [](const ContactPoint& a, const ContactPoint& b) { return a.vertex == b.vertex; };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  return points;
}

void ContactPlaces::Evaluate(const SequenceProblem& problem, int frame, const std::vector<ContactPoint>& points,
                             Eigen::Matrix3Xd* places) {
  const FrameState& state = problem.states[frame];
  kinematics_.Set(*problem.layout.model, problem.betas, state.rotations, Vector3d::Zero(), false);
  vertices_.NewFrame(kinematics_);
  const Vector3d origin = problem.layout.BodyPlace(state);
  places->resize(3, static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) {
    places->col(static_cast<Eigen::Index>(i)) =
        PointEvaluator::VertexPosition(kinematics_, points[i].vertex, &vertices_) + origin;
  }
}

}  // namespace bodyloom
