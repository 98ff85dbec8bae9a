// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/self_penetration.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "data_tools/evaluation/capped_mesh.h"
#include "data_tools/evaluation/metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/units.h"
#include "geometry/body/skinning.h"

namespace bodyloom {
namespace {

constexpr int kFramesAtATime = 32;
constexpr double kDeepFrame_m = 0.01;

/// The part whose first joint has this name, by SMPL's names; others go with their parents.
std::string PartBegunBy(const std::string& joint) {
  static const std::map<std::string, std::string> limbs = {{"shoulder", "upper_arm"}, {"elbow", "forearm"},
                                                           {"wrist", "hand"},         {"hip", "thigh"},
                                                           {"knee", "shank"},         {"ankle", "foot"}};
  if (joint == "pelvis") return "trunk";
  if (joint == "neck") return "head";
  if (joint.size() < 3 || joint[1] != '_') return "";
  const auto limb = limbs.find(joint.substr(2));
  return limb == limbs.end() ? "" : joint.substr(0, 2) + limb->second;
}

/// The solids of one body's parts, and the pairs of vertex and part to be tested.
class PartsOfShape {
 public:
  PartsOfShape(const BodyModel& body, const Eigen::VectorXd& betas, const SelfPenetrationOptions& options)
      : parts_(PartsOfBody(body)) {
    const int V = body.num_vertices(), P = num_parts();
    part_of_vertex_.resize(V);
    for (int v = 0; v < V; ++v) {
      std::vector<double> weight(P, 0.0);
      for (int i = body.influence_begin()[v]; i < body.influence_begin()[v + 1]; ++i) {
        weight[parts_.of_joint[body.influence_joint()[i]]] += body.influence_weight()[i];
      }
      part_of_vertex_[v] = static_cast<int>(std::max_element(weight.begin(), weight.end()) - weight.begin());
    }
    std::vector<std::vector<int>> faces(P);
    for (int f = 0; f < body.num_faces(); ++f) {
      const auto part = [&](int c) { return part_of_vertex_[body.data().faces(f, c)]; };
      faces[part(1) == part(2) ? part(1) : part(0)].push_back(f);
    }
    for (int p = 0; p < P; ++p) solids_.emplace_back(body.data().faces, faces[p]);
    FindTested(body, ShapeVertices(body, betas), options);
  }

  [[nodiscard]] int num_parts() const { return static_cast<int>(parts_.names.size()); }
  [[nodiscard]] const std::vector<std::string>& names() const { return parts_.names; }

  FramePenetration Measure(const MatrixX3d& vertices) {
    const int P = num_parts();
    FramePenetration result;
    result.deepest_of_pair_m.assign(static_cast<size_t>(P) * P, 0.0);
    turned_.noalias() = vertices * GenericRotation().transpose();
    for (CappedMesh& solid : solids_) solid.Place(turned_);
    for (int v = 0; v < static_cast<int>(turned_.rows()); ++v) {
      const Eigen::Vector3d p = turned_.row(v).transpose();
      double depth = 0;
      int in = -1;
      for (int s = 0; s < P; ++s) {
        if (!tested_[static_cast<size_t>(v) * P + s] || !solids_[s].Contains(p)) continue;
        const double distance = solids_[s].Distance(p);
        if (in < 0 || distance > depth) depth = distance, in = s;
        double& of_pair = result.deepest_of_pair_m[static_cast<size_t>(part_of_vertex_[v]) * P + s];
        of_pair = std::max(of_pair, distance);
      }
      if (in < 0) continue;
      ++result.vertices;
      if (result.vertex >= 0 && depth <= result.deepest_m) continue;
      result.deepest_m = depth;
      result.vertex = v, result.part = part_of_vertex_[v], result.in = in;
    }
    return result;
  }

 private:
  void FindTested(const BodyModel& body, const MatrixX3d& rest, const SelfPenetrationOptions& options) {
    const int V = body.num_vertices(), P = num_parts();
    const double height = rest.col(1).maxCoeff() - rest.col(1).minCoeff();
    std::vector<double> reach(static_cast<size_t>(P) * P, options.other_share * height);
    for (int j = 1; j < body.num_joints(); ++j) {
      const int a = parts_.of_joint[j], b = parts_.of_joint[body.parents()[j]];
      reach[static_cast<size_t>(a) * P + b] = reach[static_cast<size_t>(b) * P + a] = options.joined_share * height;
    }
    std::vector<std::vector<int>> members(P);
    for (int v = 0; v < V; ++v) members[part_of_vertex_[v]].push_back(v);
    std::vector<Eigen::ArrayX3f> places;
    for (const std::vector<int>& of_part : members) {
      Eigen::ArrayX3f& place = places.emplace_back(static_cast<Eigen::Index>(of_part.size()), 3);
      for (size_t i = 0; i < of_part.size(); ++i) {
        place.row(static_cast<Eigen::Index>(i)) = rest.row(of_part[i]).cast<float>().array();
      }
    }
    std::vector<bool> is_skin(V, false);
    for (Eigen::Index i = 0; i < body.data().faces.size(); ++i) is_skin[body.data().faces.data()[i]] = true;
    tested_.assign(static_cast<size_t>(V) * P, 0);
    ParallelFor(V, options.num_threads, [&](int v) {
      if (!is_skin[v]) return;
      const Eigen::Array3f p = rest.row(v).cast<float>().transpose().array();
      for (int s = 0; s < P; ++s) {
        if (s == part_of_vertex_[v] || solids_[s].empty() || places[s].rows() == 0) continue;
        const float square = ((places[s].col(0) - p[0]).square() + (places[s].col(1) - p[1]).square() +
                              (places[s].col(2) - p[2]).square())
                                 .minCoeff();
        const double limit = reach[static_cast<size_t>(part_of_vertex_[v]) * P + s];
        tested_[static_cast<size_t>(v) * P + s] = std::sqrt(double{square}) >= limit ? 1 : 0;
      }
    });
  }

  BodyParts parts_;
  std::vector<int> part_of_vertex_;
  std::vector<CappedMesh> solids_;
  std::vector<uint8_t> tested_;  // V × parts
  MatrixX3d turned_;
};

}  // namespace

BodyParts PartsOfBody(const BodyModel& body) {
  BodyParts parts;
  const std::vector<std::string>& joints = body.data().joint_names;
  const bool has_names = joints[0] == "pelvis";
  for (int j = 0; j < body.num_joints(); ++j) {
    const std::string begun = has_names ? PartBegunBy(joints[j]) : joints[j];
    if (begun.empty()) {
      parts.of_joint.push_back(parts.of_joint[body.parents()[j]]);
    } else {
      parts.of_joint.push_back(static_cast<int>(parts.names.size()));
      parts.names.push_back(begun);
    }
  }
  return parts;
}

SelfPenetration MeasureSelfPenetration(const Motion& motion, const std::vector<int>& frames, const BodyModel& body,
                                       const SelfPenetrationOptions& options) {
  for (const double share : {options.joined_share, options.other_share}) {
    BODYLOOM_CHECK(std::isfinite(share) && share >= 0, "MeasureSelfPenetration: a share of ", share,
                   " of the body's height, expected 0 or more");
  }
  std::vector<BodyPose> poses;
  for (const int t : frames) {
    BODYLOOM_CHECK(t >= 0 && t < motion.num_frames(), "MeasureSelfPenetration: no frame ", t);
    if (!motion.poses.row(t).allFinite()) continue;
    poses.push_back(PoseFromAxisAngle(body, motion.poses.row(t).transpose(), Eigen::Vector3d::Zero()));
  }
  const PartsOfShape parts(body, motion.betas, options);
  SelfPenetration result;
  result.parts = parts.names();
  result.num_vertices = body.num_vertices();
  result.frames.resize(poses.size());
  const Skinner skinner(body, {});
  const ShapedBody shaped = skinner.Shape(motion.betas);
  const int T = static_cast<int>(poses.size()), batches = (T + kFramesAtATime - 1) / kFramesAtATime;
  ParallelFor(batches, options.num_threads, [&](int batch) {
    const int begin = batch * kFramesAtATime, count = std::min(kFramesAtATime, T - begin);
    const size_t size = 3 * static_cast<size_t>(body.num_vertices());
    std::vector<double> vertices(count * size);
    skinner.Skin(shaped, std::span(poses).subspan(begin, count), vertices);
    PartsOfShape own = parts;
    for (int i = 0; i < count; ++i) {
      result.frames[begin + i] =
          own.Measure(Eigen::Map<const MatrixX3d>(vertices.data() + i * size, body.num_vertices(), 3));
    }
  });
  return result;
}

void AddSelfPenetration(const SelfPenetration& penetration, const std::string& prefix, Evaluation* evaluation) {
  const size_t T = penetration.frames.size(), P = penetration.parts.size();
  std::vector<double> deepest_mm, share_percent;
  double deep_frames = 0;
  std::vector<double> of_pair_mm(P * P, 0.0);
  for (const FramePenetration& frame : penetration.frames) {
    deepest_mm.push_back(frame.deepest_m * kMmPerMetre);
    share_percent.push_back(100.0 * frame.vertices / penetration.num_vertices);
    deep_frames += frame.deepest_m > kDeepFrame_m ? 1 : 0;
    for (size_t i = 0; i < of_pair_mm.size(); ++i) {
      of_pair_mm[i] += frame.deepest_of_pair_m[i] * kMmPerMetre / static_cast<double>(T);
    }
  }
  const ErrorStatistics depth = Summarize(deepest_mm);
  const std::string whose = prefix.empty() ? "" : "of the truth: ";
  evaluation->Add(prefix + "self_penetration_mm", depth.mean,
                  whose + "deepest vertex inside another part of the body, mean over frames");
  evaluation->Add(prefix + "self_penetration_p95_mm", depth.p95, whose + "95th percentile of frames");
  evaluation->Add(prefix + "self_penetration_frames_percent",
                  T > 0 ? 100 * deep_frames / static_cast<double>(T) : kNotMeasured,
                  whose + "frames in which it is deeper than 10 mm");
  evaluation->Add(prefix + "self_penetration_vertices_percent", Summarize(share_percent).mean,
                  whose + "vertices inside another part, mean over frames");
  if (!prefix.empty()) return;
  EvaluationBreakdown breakdown{"self_penetration_mm", {}, {}};
  for (size_t i = 0; i < of_pair_mm.size(); ++i) {
    if (of_pair_mm[i] == 0) continue;
    breakdown.labels.push_back(penetration.parts[i / P] + " in " + penetration.parts[i % P]);
    breakdown.values.push_back(of_pair_mm[i]);
  }
  if (!breakdown.labels.empty()) evaluation->breakdowns.push_back(std::move(breakdown));
}

}  // namespace bodyloom
