// SPDX-License-Identifier: Apache-2.0
/// A small synthetic body for tests: 804 vertices on SMPL's 24 joints, mirror symmetric, built in a millisecond.
///
/// Eight closed tubes (torso, head, arms, legs, feet) that overlap where limbs meet. Body frame as SMPL's (metres, y
/// up, x the body's left, z front, T-pose); the pelvis is NOT at the origin, as in SMPL. Height about 1.67 m.
/// - weights: smooth, at most 4 joints a vertex; J_regressor: means of rings of vertices;
/// - 6 shape components: stature, girth, leg length, arm length, torso length, belly;
/// - pose correctives at shoulders, elbows, hips and knees only, with generic (full-rank) blocks;
/// - 24 charts numbered as DensePose's (left hand 4, torso back 1 and front 2, head right 23, left 24, …), each
///   injective, and an atlas of 6×4 cells;
/// - landmarks: COCO-17 and {left,right}_{big_toe,small_toe,heel}.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"

namespace bodyloom {
namespace toy_body_internal {

using Eigen::Vector2f;
using Eigen::Vector3d;

struct Ring {
  Vector3d centre;  ///< relative to the pelvis
  double radius_a, radius_b;
};

/// Rings first..last belong to one chart for angles below π and one above (equal: one chart of two islands).
struct Section {
  int first, last;
  uint8_t part_a, part_b;
};

/// Closed elliptic tube: point(φ) = centre + radius_a cos φ · a + radius_b sin φ · b; a × b is the tube's direction.
struct Tube {
  Vector3d a, b;
  int sides;
  std::vector<Ring> rings;
  std::vector<Section> sections;
  std::vector<int> chain;        ///< joints along the tube
  std::vector<int> chain_rings;  ///< ring at which chain[i] takes over from chain[i-1]
  double blend = 0.03;           ///< metres
};

inline uint8_t MirrorPart(uint8_t part) {
  if (part <= 2) return part;
  return part % 2 == 1 ? part + 1 : part - 1;  // 3↔4, 5↔6, …, 23↔24
}

inline int MirrorJoint(int j) {
  static const std::array<int, 24> mirror = {0,  2,  1,  3,  5,  4,  6,  8,  7,  9,  11, 10,
                                             12, 14, 13, 15, 17, 16, 19, 18, 21, 20, 23, 22};
  return mirror[j];
}

class Builder {
 public:
  /// First vertex of the tube: ring i, column k is first + i·sides + k, then the start and the end apex.
  int Add(const Tube& tube, bool mirrored) {
    const int first = static_cast<int>(vertices_.size());
    const int n = tube.sides, R = static_cast<int>(tube.rings.size());
    std::vector<double> arc(R, 0.0);
    for (int i = 1; i < R; ++i) arc[i] = arc[i - 1] + (tube.rings[i].centre - tube.rings[i - 1].centre).norm();
    auto add_vertex = [&](Vector3d x, Vector3d axis_point, double s) {
      std::array<double, 24> w{};
      double rest = 1;
      for (size_t c = tube.chain.size(); c-- > 1;) {
        const double step = 1 / (1 + std::exp(-(s - arc[tube.chain_rings[c]]) / (tube.blend / 3)));
        w[Side(tube.chain[c], mirrored)] += rest * step;
        rest *= 1 - step;
      }
      w[Side(tube.chain[0], mirrored)] += rest;
      if (mirrored) x.x() = -x.x(), axis_point.x() = -axis_point.x();
      vertices_.push_back(x);
      axis_points_.push_back(axis_point);
      weights_.push_back(w);
    };
    for (int i = 0; i < R; ++i) {
      const Ring& ring = tube.rings[i];
      for (int k = 0; k < n; ++k) {
        const double phi = 2 * M_PI * k / n;
        add_vertex(ring.centre + ring.radius_a * std::cos(phi) * tube.a + ring.radius_b * std::sin(phi) * tube.b,
                   ring.centre, arc[i]);
      }
    }
    const Vector3d direction = tube.a.cross(tube.b);
    const double start_cap = 0.4 * Radius(tube.rings.front()), end_cap = 0.4 * Radius(tube.rings.back());
    add_vertex(tube.rings.front().centre - start_cap * direction, tube.rings.front().centre, 0);
    add_vertex(tube.rings.back().centre + end_cap * direction, tube.rings.back().centre, arc[R - 1]);
    const int start = first + R * n, end = start + 1;

    for (const Section& section : tube.sections) {
      const double low = section.first == 0 ? -start_cap : arc[section.first];
      const double high = section.last == R - 1 ? arc[R - 1] + end_cap : arc[section.last];
      auto uv = [&](double s, double column) {  // column in [0, n], halves split at n/2
        const bool second = column > n / 2.0;
        double u = (column - (second ? n / 2.0 : 0.0)) / (n / 2.0);
        u = section.part_a == section.part_b ? (second ? 0.52 : 0.02) + 0.46 * u : 0.02 + 0.96 * u;
        if (mirrored) u = 1 - u;
        return Vector2f(static_cast<float>(u), static_cast<float>(0.02 + 0.96 * (s - low) / (high - low)));
      };
      for (int k = 0; k < n; ++k) {
        uint8_t part = k < n / 2 ? section.part_a : section.part_b;
        if (mirrored) part = MirrorPart(part);
        const int next = (k + 1) % n;
        const double nudge = k < n / 2 ? 0 : 1e-9;  // the left edge of the second half belongs to the second half
        for (int i = section.first; i < section.last; ++i) {
          const int p = first + i * n + k, q = first + i * n + next;
          const Vector2f uv_p = uv(arc[i], k + nudge), uv_q = uv(arc[i], k + 1 - 1e-9 + nudge);
          const Vector2f uv_pn = uv(arc[i + 1], k + nudge), uv_qn = uv(arc[i + 1], k + 1 - 1e-9 + nudge);
          AddFace({p, q, q + n}, {uv_p, uv_q, uv_qn}, part, mirrored);
          AddFace({p, q + n, p + n}, {uv_p, uv_qn, uv_pn}, part, mirrored);
        }
        if (section.first == 0) {
          AddFace({first + next, first + k, start},
                  {uv(0, k + 1 - 1e-9 + nudge), uv(0, k + nudge), uv(-start_cap, k + 0.5)}, part, mirrored);
        }
        if (section.last == R - 1) {
          const int p = first + (R - 1) * n;
          AddFace({p + k, p + next, end},
                  {uv(arc[R - 1], k + nudge), uv(arc[R - 1], k + 1 - 1e-9 + nudge), uv(arc[R - 1] + end_cap, k + 0.5)},
                  part, mirrored);
        }
      }
    }
    return first;
  }

  static double Radius(const Ring& ring) { return 0.5 * (ring.radius_a + ring.radius_b); }
  static int Side(int joint, bool mirrored) { return mirrored ? MirrorJoint(joint) : joint; }

  std::vector<Vector3d> vertices_, axis_points_;  ///< relative to the pelvis
  std::vector<std::array<double, 24>> weights_;
  std::vector<std::array<int, 3>> faces_, uv_faces_;
  std::vector<uint8_t> face_part_;
  std::vector<std::array<Vector2f, 3>> face_iuv_;
  std::vector<Vector2f> uv_vertices_;

 private:
  void AddFace(std::array<int, 3> face, std::array<Vector2f, 3> uv, uint8_t part, bool mirrored) {
    if (mirrored) std::swap(face[1], face[2]), std::swap(uv[1], uv[2]);  // keeps faces counter-clockwise from outside
    faces_.push_back(face);
    face_iuv_.push_back(uv);
    face_part_.push_back(part);
    std::array<int, 3> uv_face{};
    for (int c = 0; c < 3; ++c) {
      const auto key = std::make_tuple(int{part}, face[c], std::lround(uv[c].x() * 1e6));
      const auto [it, added] = uv_index_.try_emplace(key, static_cast<int>(uv_vertices_.size()));
      if (added) {
        uv_vertices_.emplace_back((float((part - 1) / 6) + uv[c].x()) / 4, (float((part - 1) % 6) + uv[c].y()) / 6);
      }
      uv_face[c] = it->second;
    }
    uv_faces_.push_back(uv_face);
  }

  std::map<std::tuple<int, int, long>, int> uv_index_;
};

inline Tube TorsoTube() {
  return {Vector3d::UnitX(),
          -Vector3d::UnitZ(),
          12,
          {{{0, -.13, 0}, .09, .07},
           {{0, -.08, 0}, .16, .112},
           {{0, 0, 0}, .168, .118},
           {{0, .06, 0}, .158, .112},
           {{0, .116, 0}, .148, .107},
           {{0, .18, 0}, .148, .105},
           {{0, .247, 0}, .155, .110},
           {{0, .305, 0}, .165, .113},
           {{0, .36, 0}, .168, .105},
           {{0, .415, -.005}, .145, .085},
           {{0, .455, -.01}, .085, .06}},
          {{0, 10, 1, 2}},
          {0, 3, 6, 9},
          {0, 4, 6, 7},
          0.12};
}
inline Tube HeadTube() {
  return {Vector3d::UnitZ(),
          Vector3d::UnitX(),
          10,
          {{{0, .44, -.01}, .055, .06},
           {{0, .487, -.005}, .052, .052},
           {{0, .53, .005}, .058, .054},
           {{0, .586, .02}, .085, .065},
           {{0, .62, .025}, .098, .074},
           {{0, .67, .02}, .1, .078},
           {{0, .71, .015}, .083, .063},
           {{0, .735, .01}, .045, .034}},
          {{0, 7, 24, 23}},
          {12, 15},
          {0, 3},
          0.05};
}
inline Tube LeftArmTube() {
  const double y = .42, z = -.01;
  return {Vector3d::UnitY(),
          Vector3d::UnitZ(),
          8,
          {{{.11, y - .02, z}, .05, .05},
           {{.18, y, z}, .054, .052},
           {{.24, y, z}, .048, .048},
           {{.32, y, z}, .045, .045},
           {{.40, y, z}, .042, .042},
           {{.455, y, z}, .040, .040},
           {{.51, y, z}, .041, .041},
           {{.58, y, z}, .037, .037},
           {{.65, y, z}, .028, .031},
           {{.70, y, z}, .023, .029},
           {{.74, y, z}, .016, .038},
           {{.78, y, z}, .015, .041},
           {{.83, y, z}, .012, .038},
           {{.87, y, z}, .008, .028}},
          {{0, 5, 15, 17}, {5, 9, 19, 21}, {9, 13, 4, 4}},
          {13, 16, 18, 20, 22},
          {0, 1, 5, 9, 11},
          0.05};
}
inline Tube LeftLegTube() {
  return {Vector3d::UnitX(),
          Vector3d::UnitZ(),
          10,
          {{{.075, -.085, 0}, .075, .085},
           {{.078, -.16, .002}, .078, .086},
           {{.08, -.24, .004}, .074, .08},
           {{.082, -.32, .005}, .067, .07},
           {{.085, -.40, .005}, .058, .06},
           {{.086, -.455, .004}, .052, .055},
           {{.087, -.51, 0}, .050, .053},
           {{.088, -.58, -.006}, .050, .055},
           {{.089, -.66, -.010}, .045, .048},
           {{.090, -.74, -.014}, .036, .040},
           {{.090, -.81, -.016}, .033, .038},
           {{.090, -.85, -.016}, .034, .042}},
          {{0, 5, 10, 8}, {5, 11, 14, 12}},
          {1, 4, 7},
          {0, 5, 11},
          0.06};
}
inline Tube LeftFootTube() {
  const double x = .09;
  return {Vector3d::UnitX(),
          Vector3d::UnitY(),
          8,
          {{{x, -.889, -.070}, .024, .020},
           {{x, -.882, -.045}, .033, .033},
           {{x, -.876, -.012}, .036, .044},
           {{x, -.884, .045}, .039, .034},
           {{x, -.896, .10}, .043, .023},
           {{x, -.900, .14}, .041, .018},
           {{x, -.903, .168}, .029, .013}},
          {{0, 6, 5, 5}},
          {7, 10},
          {0, 4},
          0.05};
}

}  // namespace toy_body_internal

/// The arrays of the toy body, for tests that modify them.
inline BodyModelData ToyBodyData() {
  using namespace toy_body_internal;  // NOLINT: local to this function
  const Vector3d pelvis(0, -0.2, 0.02);
  const Tube torso = TorsoTube(), head = HeadTube(), arm = LeftArmTube(), leg = LeftLegTube(), foot = LeftFootTube();
  Builder builder;
  const int torso_0 = builder.Add(torso, false), head_0 = builder.Add(head, false);
  const int arm_0[2] = {builder.Add(arm, false), builder.Add(arm, true)};
  const int leg_0[2] = {builder.Add(leg, false), builder.Add(leg, true)};
  const int foot_0[2] = {builder.Add(foot, false), builder.Add(foot, true)};
  const int V = static_cast<int>(builder.vertices_.size()), F = static_cast<int>(builder.faces_.size());
  const int nose = head_0 + 4 * head.sides;
  builder.vertices_[nose].z() += 0.022;

  // Hips pull the lower sides of the torso, collars the upper ones.
  for (int v = torso_0; v < head_0; ++v) {
    const Vector3d& x = builder.vertices_[v];
    const double side = 0.6 / (1 + std::exp(-(std::abs(x.x()) - 0.08) / 0.02));
    const double hip = side / (1 + std::exp((x.y() + 0.06) / 0.015));
    const double collar = side / (1 + std::exp(-(x.y() - 0.34) / 0.02));
    for (double& w : builder.weights_[v]) w *= 1 - hip - collar;
    builder.weights_[v][x.x() > 0 ? 1 : 2] += hip;
    builder.weights_[v][x.x() > 0 ? 13 : 14] += collar;
  }

  BodyModelData d;
  d.name = "toy";
  d.joint_names = SmplJointNames();
  d.parents = SmplParents();
  d.v_template.resize(V, 3);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < V; ++v) {
    d.v_template.row(v) = (builder.vertices_[v] + pelvis).transpose();
    double sum = 0;
    for (double w : builder.weights_[v]) sum += w > 0.01 ? w : 0;
    for (int j = 0; j < 24; ++j) {
      if (builder.weights_[v][j] > 0.01) entries.emplace_back(v, j, builder.weights_[v][j] / sum);
    }
  }
  d.weights.resize(V, 24);
  d.weights.setFromTriplets(entries.begin(), entries.end());

  // Joints: means of rings.
  entries.clear();
  auto ring_mean = [&](int joint, int tube_first, const Tube& tube, int ring, double weight) {
    for (int k = 0; k < tube.sides; ++k) {
      entries.emplace_back(joint, tube_first + ring * tube.sides + k, weight / tube.sides);
    }
  };
  ring_mean(0, torso_0, torso, 2, 1);
  ring_mean(3, torso_0, torso, 4, 1);
  ring_mean(6, torso_0, torso, 6, 1);
  ring_mean(9, torso_0, torso, 7, 1);
  ring_mean(12, head_0, head, 1, 1);
  ring_mean(15, head_0, head, 3, 1);
  for (int side = 0; side < 2; ++side) {
    ring_mean(1 + side, leg_0[side], leg, 0, 1);
    ring_mean(4 + side, leg_0[side], leg, 5, 1);
    ring_mean(7 + side, leg_0[side], leg, 11, 1);
    ring_mean(10 + side, foot_0[side], foot, 4, 1);
    ring_mean(13 + side, torso_0, torso, 7, 0.5);
    ring_mean(13 + side, arm_0[side], arm, 1, 0.5);
    ring_mean(16 + side, arm_0[side], arm, 1, 1);
    ring_mean(18 + side, arm_0[side], arm, 5, 1);
    ring_mean(20 + side, arm_0[side], arm, 9, 1);
    ring_mean(22 + side, arm_0[side], arm, 11, 1);
  }
  d.J_regressor.resize(24, V);
  d.J_regressor.setFromTriplets(entries.begin(), entries.end());

  // Shape, metres per unit.
  d.shapedirs = RowMatrixXf::Zero(3 * V, 6);
  for (int v = 0; v < V; ++v) {
    const Vector3d& x = builder.vertices_[v];
    const Vector3d radial = x - builder.axis_points_[v];
    const bool is_arm = v >= arm_0[0] && v < leg_0[0], is_leg = v >= leg_0[0];
    const auto set = [&](int component, const Vector3d& offset) {
      for (int c = 0; c < 3; ++c) d.shapedirs(3 * v + c, component) = static_cast<float>(offset[c]);
    };
    set(0, 0.045 * x);
    set(1, (is_arm || is_leg ? 0.08 : 0.12) * radial);
    set(2, is_leg ? Vector3d(0, 0.035 * (x.y() + 0.085), 0) : Vector3d::Zero().eval());
    set(3, is_arm ? Vector3d(0.04 * x.x(), 0, 0) : Vector3d::Zero().eval());
    set(4, Vector3d(0, 0.04 * (is_leg ? 0 : std::max(0.0, std::min(x.y(), 0.45))), 0));
    set(5, v < head_0 ? Vector3d(0, 0, x.z() > 0 ? 0.03 * std::exp(-std::pow((x.y() - 0.06) / 0.1, 2)) : 0)
                      : Vector3d::Zero().eval());
  }

  // Correctives: bulge outwards plus a generic part, fading with the distance from the joint.
  d.posedirs.begin.push_back(0);
  for (int v = 0; v < V; ++v) {
    for (const int joint : {1, 2, 4, 5, 16, 17, 18, 19}) {
      const double w = builder.weights_[v][joint], blend = 4 * w * (1 - w);
      if (blend < 0.05) continue;
      const Vector3d radial = builder.vertices_[v] - builder.axis_points_[v];
      d.posedirs.joint.push_back(joint);
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 9; ++k) {
          const double generic = std::sin(1.7 * c + 0.9 * k + 0.3 * joint);
          d.posedirs.block.push_back(
              static_cast<float>(blend * ((k % 4 == 0 ? -0.08 : 0.02) * radial[c] + 0.002 * generic)));
        }
      }
    }
    d.posedirs.begin.push_back(static_cast<int>(d.posedirs.joint.size()));
  }

  d.faces.resize(F, 3);
  d.ft.resize(F, 3);
  d.face_iuv.resize(F, 6);
  d.face_part = builder.face_part_;
  for (int f = 0; f < F; ++f) {
    for (int c = 0; c < 3; ++c) {
      d.faces(f, c) = builder.faces_[f][c];
      d.ft(f, c) = builder.uv_faces_[f][c];
      d.face_iuv.block<1, 2>(f, 2 * c) = builder.face_iuv_[f][c].transpose();
    }
  }
  d.vt.resize(static_cast<Eigen::Index>(builder.uv_vertices_.size()), 2);
  for (size_t i = 0; i < builder.uv_vertices_.size(); ++i) d.vt.row(i) = builder.uv_vertices_[i].transpose();

  // Landmarks.
  const auto point = [&](const std::string& name, int vertex) { d.landmarks.push_back({name, {vertex}, {1.0}}); };
  const auto joint = [&](const std::string& name, int j) {
    Landmark landmark{name, {}, {}};
    for (SparseRows::InnerIterator it(d.J_regressor, j); it; ++it) {
      landmark.vertices.push_back(static_cast<int>(it.col()));
      landmark.weights.push_back(it.value());
    }
    d.landmarks.push_back(std::move(landmark));
  };
  const auto head_vertex = [&](int ring, int column) { return head_0 + ring * head.sides + column; };
  const auto foot_vertex = [&](int side, int ring, int column) { return foot_0[side] + ring * foot.sides + column; };
  const char* const sides[2] = {"left_", "right_"};
  point("nose", nose);
  for (int s = 0; s < 2; ++s) point(sides[s] + std::string("eye"), head_vertex(5, s == 0 ? 1 : 9));
  for (int s = 0; s < 2; ++s) point(sides[s] + std::string("ear"), head_vertex(4, s == 0 ? 3 : 7));
  const std::pair<const char*, int> jointed[] = {{"shoulder", 16}, {"elbow", 18}, {"wrist", 20},
                                                 {"hip", 1},       {"knee", 4},   {"ankle", 7}};
  for (const auto& [name, j] : jointed) {
    for (int s = 0; s < 2; ++s) joint(sides[s] + std::string(name), j + s);
  }
  for (int s = 0; s < 2; ++s) point(sides[s] + std::string("big_toe"), foot_vertex(s, 6, 4));
  for (int s = 0; s < 2; ++s) point(sides[s] + std::string("small_toe"), foot_vertex(s, 5, 0));
  for (int s = 0; s < 2; ++s) point(sides[s] + std::string("heel"), foot_0[s] + 7 * foot.sides);
  return d;
}

/// The toy body, built once.
inline const BodyModel& ToyBody() {
  static const BodyModel body(ToyBodyData());
  return body;
}

}  // namespace bodyloom
