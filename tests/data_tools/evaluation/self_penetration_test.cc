// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/self_penetration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "tests/support/meshes.h"

namespace bodyloom::self_penetration_test {
namespace {

using Eigen::Vector3d;

struct Piece {
  TestMesh mesh;
  int joint;
};

/// Joints "root", "a", "b", "c"; a and b are children of the root, c of b. Joint b stands at (hinge_x, 0, 0), the
/// others at the origin: turned by 180° about z, what hangs on b goes from x to 2·hinge_x − x.
BodyModel BodyOf(const std::vector<Piece>& pieces, double hinge_x) {
  BodyModelData d;
  d.name = "pieces";
  d.joint_names = {"root", "a", "b", "c"};
  d.parents = {-1, 0, 0, 2};
  int V = 2, F = 0;
  for (const Piece& piece : pieces) V += int(piece.mesh.vertices.rows()), F += int(piece.mesh.faces.rows());
  d.v_template = MatrixX3d::Zero(V, 3);
  d.v_template(1, 0) = hinge_x;
  d.faces.resize(F, 3);
  d.shapedirs.resize(3 * V, 0);
  std::vector<Eigen::Triplet<double>> weights = {{0, 0, 1.0}, {1, 0, 1.0}};
  int v = 2, f = 0;
  for (const Piece& piece : pieces) {
    for (Eigen::Index i = 0; i < piece.mesh.faces.rows(); ++i) {
      d.faces.row(f++) = (piece.mesh.faces.row(i).array() + v).matrix();
    }
    for (Eigen::Index i = 0; i < piece.mesh.vertices.rows(); ++i) {
      weights.emplace_back(v, piece.joint, 1.0);
      d.v_template.row(v++) = piece.mesh.vertices.row(i);
    }
  }
  d.weights.resize(V, 4);
  d.weights.setFromTriplets(weights.begin(), weights.end());
  const std::vector<Eigen::Triplet<double>> regressor = {{0, 0, 1.0}, {1, 0, 1.0}, {2, 1, 1.0}, {3, 0, 1.0}};
  d.J_regressor.resize(4, V);
  d.J_regressor.setFromTriplets(regressor.begin(), regressor.end());
  return BodyModel(std::move(d));
}

/// A box with n×n squares a side.
TestMesh Box(const Vector3d& centre, const Vector3d& half, int n) {
  std::map<std::array<int, 3>, int> index;
  std::vector<std::array<int, 3>> points;
  std::vector<std::array<int, 3>> faces;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [entry, is_new] = index.try_emplace(p, static_cast<int>(points.size()));
    if (is_new) points.push_back(p);
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int end : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> p{};
            p[axis] = end, p[(axis + 1) % 3] = i + di, p[(axis + 2) % 3] = j + dj;
            return vertex(p);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (end == n) {
            faces.push_back({a, b, c}), faces.push_back({a, c, d});
          } else {
            faces.push_back({a, c, b}), faces.push_back({a, d, c});
          }
        }
      }
    }
  }
  TestMesh mesh{MatrixX3d(points.size(), 3), MatrixX3i(faces.size(), 3)};
  for (size_t i = 0; i < points.size(); ++i) {
    for (int c = 0; c < 3; ++c) mesh.vertices(i, c) = centre[c] + half[c] * (2.0 * points[i][c] / n - 1);
  }
  for (size_t i = 0; i < faces.size(); ++i) mesh.faces.row(i) << faces[i][0], faces[i][1], faces[i][2];
  return mesh;
}

TestMesh Ball(const Vector3d& centre, double radius) {
  TestMesh ball = UnitSphere(4);
  ball.vertices = ((radius * ball.vertices).rowwise() + centre.transpose()).eval();
  return ball;
}

Motion OnePose(int joints, int joint = -1, const Vector3d& axis_angle = Vector3d::Zero()) {
  Motion motion;
  motion.poses = RowMatrixXd::Zero(1, 3 * joints);
  motion.trans = MatrixX3d::Zero(1, 3);
  motion.timestamps = {0};
  if (joint >= 0) motion.poses.block<1, 3>(0, 3 * joint) = axis_angle.transpose();
  return motion;
}

FramePenetration Measure(const BodyModel& body, const Motion& motion, const SelfPenetrationOptions& options = {}) {
  const SelfPenetration result = MeasureSelfPenetration(motion, {0}, body, options);
  EXPECT_EQ(result.frames.size(), 1u);
  return result.frames.at(0);
}

const Vector3d kHalfTurn(0, 0, std::numbers::pi);

/// Box b comes to lie [0.26, 0.46] × [−0.08, 0.08]², box a is [0.4, 0.6] × [−0.1, 0.1]²: they share 0.06 m of x.
TEST(SelfPenetration, BoxesThatOverlapByAKnownDepth) {
  const Piece root{Box({0, 1, 0}, {0.1, 0.1, 0.1}, 2), 0}, a{Box({0.5, 0, 0}, {0.1, 0.1, 0.1}, 8), 1},
      b{Box({-0.5, 0, 0}, {0.1, 0.08, 0.08}, 8), 2};
  const BodyModel body = BodyOf({root, a, b}, -0.07);
  EXPECT_EQ(Measure(body, OnePose(4)).deepest_m, 0);
  EXPECT_EQ(Measure(body, OnePose(4)).vertex, -1);

  const FramePenetration turned = Measure(body, OnePose(4, 2, kHalfTurn));
  EXPECT_NEAR(turned.deepest_m, 0.06, 1e-6);
  // b's vertices beyond x = 0.4: the end at 0.46 and the ring of side vertices at 0.435, 0.41. a's: those of its end at
  // 0.4 within ±0.08.
  EXPECT_EQ(turned.vertices, 9 * 9 + 2 * 4 * 8 + 7 * 7);
  const SelfPenetration all = MeasureSelfPenetration(OnePose(4, 2, kHalfTurn), {0}, body, {});
  EXPECT_EQ(all.parts, (std::vector<std::string>{"root", "a", "b", "c"}));
  EXPECT_NEAR(all.frames[0].deepest_of_pair_m[1 * 4 + 2], 0.06, 1e-6) << "a in b";
  EXPECT_NEAR(all.frames[0].deepest_of_pair_m[2 * 4 + 1], 0.06, 1e-6) << "b in a";
  EXPECT_EQ(all.frames[0].deepest_of_pair_m[0 * 4 + 1], 0);
}

TEST(SelfPenetration, BallsThatOverlapByAKnownDepth) {
  const Piece root{Ball({0, 1, 0}, 0.1), 0}, a{Ball({0.5, 0, 0}, 0.1), 1}, b{Ball({-0.5, 0, 0}, 0.1), 2};
  for (const double overlap : {0.01, 0.03, 0.09}) {  // b comes to lie at 0.3 + overlap
    const BodyModel body = BodyOf({root, a, b}, (overlap - 0.2) / 2);
    EXPECT_NEAR(Measure(body, OnePose(4, 2, kHalfTurn)).deepest_m, overlap, 2e-4);
  }
  const BodyModel apart = BodyOf({root, a, b}, -0.11);
  EXPECT_EQ(Measure(apart, OnePose(4, 2, kHalfTurn)).deepest_m, 0);
}

TEST(SelfPenetration, EveryFrameIsItsOwn) {
  const Piece root{Box({0, 1, 0}, {0.1, 0.1, 0.1}, 2), 0}, a{Box({0.5, 0, 0}, {0.1, 0.1, 0.1}, 4), 1},
      b{Box({-0.5, 0, 0}, {0.1, 0.08, 0.08}, 4), 2};
  const BodyModel body = BodyOf({root, a, b}, -0.07);
  Motion motion = OnePose(4);
  motion.poses = RowMatrixXd::Zero(70, 12);
  motion.trans = MatrixX3d::Zero(70, 3);
  motion.poses.block<1, 3>(45, 6) = kHalfTurn.transpose();
  std::vector<int> frames(70);
  std::iota(frames.begin(), frames.end(), 0);
  const SelfPenetration all = MeasureSelfPenetration(motion, frames, body);
  ASSERT_EQ(all.frames.size(), 70U);
  for (int t = 0; t < 70; ++t) EXPECT_NEAR(all.frames[t].deepest_m, t == 45 ? 0.06 : 0, 1e-6) << t;
}

/// Ball b comes to lie in the middle of a, and both in the root's large ball: the deeper counts. The vertices that
/// joints are regressed from, at the origin and in no face, lie in that ball too and are no skin.
TEST(SelfPenetration, OfTwoPartsTheDeeperCountsAndLoneVerticesDoNot) {
  const Piece root{Ball({0.42, 0, 0}, 0.5), 0}, top{Box({0, 2, 0}, {0.1, 0.1, 0.1}, 1), 0},
      a{Ball({0.42, 0, 0}, 0.05), 1}, b{Ball({-1.5, 0, 0}, 0.01), 2};
  const BodyModel body = BodyOf({root, top, a, b}, -0.54);  // b goes from -1.5 to 0.42
  const SelfPenetrationOptions all{.joined_share = 0, .other_share = 0};
  const FramePenetration turned = Measure(body, OnePose(4, 2, kHalfTurn), all);
  EXPECT_EQ(turned.vertices, 2 * UnitSphere(4).vertices.rows()) << "all of a and b";
  EXPECT_NEAR(turned.deepest_of_pair_m[2 * 4 + 1], 0.05, 0.011) << "b in a";
  EXPECT_NEAR(turned.deepest_m, 0.5, 0.012) << "b in the root's ball";
  EXPECT_EQ(turned.part, 2);
  EXPECT_EQ(turned.in, 0);

  const Piece far_root{Ball({0, 1, 0}, 0.1), 0}, over_origin{Ball({0.02, 0, 0}, 0.1), 1};
  EXPECT_EQ(Measure(BodyOf({far_root, over_origin}, 0), OnePose(4), all).vertices, 0);
}

/// Balls of 50 mm, 20 mm apart at rest, one swung 50 mm towards the other on an arm of 10 m: 30 mm of overlap. The body
/// is 1.15 m high, so what is closer than 34.5 mm at rest is left out. Of a point at the angle θ from the middle of the
/// facing side, |p − a|² is 0.0169 − 0.012 cos θ at rest and 0.0074 − 0.007 cos θ then: with 84.5 mm at rest it is 8.7
/// mm deep.
TEST(SelfPenetration, NeighboursAtRestAreLeftOut) {
  const Piece root{Ball({0, 1, 0}, 0.1), 0}, a{Ball({10, 0.12, 0}, 0.05), 1}, b{Ball({10, 0, 0}, 0.05), 2};
  const BodyModel body = BodyOf({root, a, b}, 0);
  const Motion swung = OnePose(4, 2, Vector3d(0, 0, std::asin(0.005)));
  EXPECT_EQ(Measure(body, OnePose(4)).deepest_m, 0);
  EXPECT_NEAR(Measure(body, swung, {.other_share = 0}).deepest_m, 0.03, 3e-4);
  EXPECT_NEAR(Measure(body, swung).deepest_m, 0.0087, 1e-3);
  EXPECT_EQ(Measure(body, swung, {.other_share = 0.06}).deepest_m, 0);
}

/// Two balls on parent and child, 60 mm apart at rest and 40 mm into each other when the child's joint is turned by a
/// right angle: with the joined share nothing is tested, without it all is.
TEST(SelfPenetration, JoinedPartsAreLeftOutFurther) {
  // Root's ball lies at (0, −0.16, 0); b hangs at (0.1, 0, 0) and comes down to (0, −0.1, 0).
  const Piece tall{Box({0, 1, 1}, {0.05, 0.05, 0.05}, 1), 0}, root{Ball({0, -0.16, 0}, 0.05), 0},
      b{Ball({0.1, 0, 0}, 0.05), 2};
  const BodyModel body = BodyOf({tall, root, b}, 0);
  const Motion turn = OnePose(4, 2, Vector3d(0, 0, -std::numbers::pi / 2));
  EXPECT_NEAR(Measure(body, turn, {.joined_share = 0, .other_share = 0}).deepest_m, 0.04, 2e-4);
  // At rest the balls are 0.0887 m apart, 7 % of 1.26 m: some vertices are tested at 9 %, none at 16 %.
  EXPECT_EQ(Measure(body, turn, {.joined_share = 0.16}).deepest_m, 0);
  EXPECT_GT(Measure(body, turn, {.joined_share = 0.07}).deepest_m, 0);
  EXPECT_GT(Measure(body, turn, {.joined_share = 0.07, .other_share = 0.9}).deepest_m, 0)
      << "the other share is others'";
}

TEST(SelfPenetration, PartsOfSmplsJoints) {
  const BodyParts parts = PartsOfBody(BuiltinBody());
  EXPECT_EQ(parts.names,
            (std::vector<std::string>{"trunk", "l_thigh", "r_thigh", "l_shank", "r_shank", "l_foot", "r_foot", "head",
                                      "l_upper_arm", "r_upper_arm", "l_forearm", "r_forearm", "l_hand", "r_hand"}));
  const auto part = [&](const char* joint) { return parts.names[parts.of_joint[BuiltinBody().FindJoint(joint)]]; };
  EXPECT_EQ(part("spine3"), "trunk");
  EXPECT_EQ(part("l_collar"), "trunk");
  EXPECT_EQ(part("head"), "head");
  EXPECT_EQ(part("r_hand"), "r_hand");
  EXPECT_EQ(part("l_foot"), "l_foot");
}

// ---- a slow twin ----------------------------------------------------------------------------------------------------

/// The point of a triangle nearest to p, by regions (Ericson, "Real-Time Collision Detection", 5.1.5).
Vector3d NearestOnTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

/// The definition, in double and in the posed frame: solid angles over a part's faces and the fans of its loops; every
/// face of the part for the distance.
class SlowTwin {
 public:
  explicit SlowTwin(const BodyModel& body) : body_(body), parts_(PartsOfBody(body)) {
    for (int v = 0; v < body.num_vertices(); ++v) {
      std::map<int, double> sums;
      for (SparseRows::InnerIterator it(body.data().weights, v); it; ++it) {
        sums[parts_.of_joint[it.col()]] += it.value();
      }
      part_.push_back(
          std::max_element(sums.begin(), sums.end(), [](auto& a, auto& b) { return a.second < b.second; })->first);
    }
    faces_.resize(parts_.names.size());
    loops_.resize(parts_.names.size());
    boundary_.resize(parts_.names.size());
    loop_of_edge_.resize(parts_.names.size());
    for (int f = 0; f < body.num_faces(); ++f) {
      const int a = part_[body.data().faces(f, 0)], b = part_[body.data().faces(f, 1)],
                c = part_[body.data().faces(f, 2)];
      faces_[a == b || a == c ? a : b == c ? b : a].push_back(body.data().faces.row(f));
    }
    for (size_t s = 0; s < faces_.size(); ++s) {
      std::map<std::pair<int, int>, int> half;
      for (const auto& f : faces_[s]) {
        for (int c = 0; c < 3; ++c) ++half[{f[c], f[(c + 1) % 3]}];
      }
      std::map<int, int> loop;  // vertex → the lowest vertex that it is connected with along the boundary
      for (const auto& [edge, count] : half) {
        EXPECT_EQ(count, 1);
        if (half.contains({edge.second, edge.first})) continue;
        boundary_[s].push_back({edge.second, edge.first});
        loop[edge.first] = edge.first, loop[edge.second] = edge.second;
      }
      for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [from, to] : boundary_[s]) {
          const int lowest = std::min(loop[from], loop[to]);
          changed |= loop[from] != lowest || loop[to] != lowest;
          loop[from] = loop[to] = lowest;
        }
      }
      for (const auto& [vertex, lowest] : loop) loops_[s][lowest].push_back(vertex);
      for (const auto& [from, to] : boundary_[s]) loop_of_edge_[s].push_back(loop[from]);
    }
    rest_ = ShapeVertices(body, Eigen::VectorXd::Zero(body.num_betas()));
  }

  FramePenetration Measure(const MatrixX3d& x) const {
    FramePenetration result;
    const double height = rest_.col(1).maxCoeff() - rest_.col(1).minCoeff();
    for (int v = 0; v < body_.num_vertices(); ++v) {
      const Vector3d p = x.row(v).transpose();
      double deepest = -1;
      for (int s = 0; s < static_cast<int>(faces_.size()); ++s) {
        if (s == part_[v] || !InBox(s, x, p)) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (int u = 0; u < body_.num_vertices(); ++u) {
          if (part_[u] == s) nearest = std::min(nearest, (rest_.row(u) - rest_.row(v)).norm());
        }
        if (nearest < (Joined(part_[v], s) ? 0.09 : 0.03) * height) continue;
        if (std::lround(Winding(s, x, p)) == 0) continue;
        double distance = std::numeric_limits<double>::infinity();
        for (const auto& f : faces_[s]) {
          const Vector3d on =
              NearestOnTriangle(p, x.row(f[0]).transpose(), x.row(f[1]).transpose(), x.row(f[2]).transpose());
          distance = std::min(distance, (on - p).norm());
        }
        deepest = std::max(deepest, distance);
      }
      if (deepest < 0) continue;
      ++result.vertices;
      if (deepest > result.deepest_m) result.deepest_m = deepest, result.vertex = v;
    }
    return result;
  }

 private:
  bool Joined(int a, int b) const {
    for (int j = 1; j < body_.num_joints(); ++j) {
      const int p = parts_.of_joint[j], q = parts_.of_joint[body_.parents()[j]];
      if ((p == a && q == b) || (p == b && q == a)) return true;
    }
    return false;
  }
  bool InBox(int s, const MatrixX3d& x, const Vector3d& p) const {
    Vector3d low = Vector3d::Constant(1e9), high = -low;
    for (const auto& f : faces_[s]) {
      for (int c = 0; c < 3; ++c)
        low = low.cwiseMin(x.row(f[c]).transpose()), high = high.cwiseMax(x.row(f[c]).transpose());
    }
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
  static double Angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double l = a.norm(), m = b.norm(), n = c.norm();
    return 2 * std::atan2(a.dot(b.cross(c)), l * m * n + a.dot(b) * n + b.dot(c) * l + c.dot(a) * m);
  }
  double Winding(int s, const MatrixX3d& x, const Vector3d& p) const {
    double sum = 0;
    const auto from_p = [&](int v) -> Vector3d { return x.row(v).transpose() - p; };
    for (const auto& f : faces_[s]) sum += Angle(from_p(f[0]), from_p(f[1]), from_p(f[2]));
    for (size_t i = 0; i < boundary_[s].size(); ++i) {
      const std::vector<int>& loop = loops_[s].at(loop_of_edge_[s][i]);
      Vector3d mean = Vector3d::Zero();
      for (const int v : loop) mean += from_p(v) / static_cast<double>(loop.size());
      sum += Angle(from_p(boundary_[s][i].first), from_p(boundary_[s][i].second), mean);
    }
    return sum / (4 * std::numbers::pi);
  }

  const BodyModel& body_;
  BodyParts parts_;
  std::vector<int> part_;
  std::vector<std::vector<Eigen::RowVector3i>> faces_;
  std::vector<std::map<int, std::vector<int>>> loops_;
  std::vector<std::vector<std::pair<int, int>>> boundary_;  ///< half-edges the other way round
  std::vector<std::vector<int>> loop_of_edge_;
  MatrixX3d rest_;
};

/// Arms pressed into the trunk, crossed legs, a hand in the head: poses that no person takes.
Motion BadPoses() {
  Motion motion = OnePose(24);
  motion.poses = RowMatrixXd::Zero(6, 72);
  motion.trans = MatrixX3d::Zero(6, 3);
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 0.5);
  for (int t = 0; t < 6; ++t) {
    motion.timestamps.push_back(t + 1);
    for (int i = 3; i < 72; ++i) motion.poses(t, i) = noise(random);
    motion.poses(t, 3 * 16 + 2) -= 1.3, motion.poses(t, 3 * 17 + 2) += 1.3;  // arms down
    motion.trans.row(t) << 0.1 * t, 1, 4;
  }
  motion.timestamps.resize(6);
  return motion;
}

TEST(SelfPenetration, AgreesWithTheSlowTwin) {
  const BodyModel& body = BuiltinBody();
  const Motion motion = BadPoses();
  const SelfPenetration fast = MeasureSelfPenetration(motion, {0, 1, 2, 3, 4, 5}, body);
  ASSERT_EQ(fast.frames.size(), 6u);
  const SlowTwin twin(body);
  int vertices = 0;
  for (int t = 0; t < 6; ++t) {
    const MatrixX3d x = PoseVertices(body, {}, PoseFromAxisAngle(body, motion.poses.row(t).transpose(), {0, 0, 0}));
    const FramePenetration slow = twin.Measure(x);
    EXPECT_NEAR(fast.frames[t].deepest_m, slow.deepest_m, 1e-5) << "frame " << t;  // skinned in float
    EXPECT_NEAR(fast.frames[t].vertices, slow.vertices, 1) << "frame " << t;
    vertices += slow.vertices;
  }
  EXPECT_GT(vertices, 500);
}

TEST(SelfPenetration, IsTheSameForAnyNumberOfThreads) {
  Motion motion = BadPoses();
  const std::vector<int> frames = {5, 0, 3, 3};
  const SelfPenetration one = MeasureSelfPenetration(motion, frames, BuiltinBody());
  const SelfPenetration four = MeasureSelfPenetration(motion, frames, BuiltinBody(), {.num_threads = 4});
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(one.frames[i].deepest_m, four.frames[i].deepest_m);
    EXPECT_EQ(one.frames[i].deepest_of_pair_m, four.frames[i].deepest_of_pair_m);
  }
  EXPECT_EQ(one.frames[2].deepest_m, one.frames[3].deepest_m);
}

/// The built-in body does not penetrate itself at rest, nor with its arms hanging or legs together.
TEST(SelfPenetration, NaturalPosesHaveNone) {
  const BodyModel& body = BuiltinBody();
  EXPECT_EQ(Measure(body, OnePose(24)).deepest_m, 0);
  Motion stand = OnePose(24);
  stand.poses(0, 3 * 16 + 2) = -1.25, stand.poses(0, 3 * 17 + 2) = 1.25;  // arms 72° down
  EXPECT_LT(Measure(body, stand).deepest_m, 0.002);
}

/// The left arm hangs and is pressed further in, degree by degree. The forearm enters the trunk's side from outside, so
/// every radian takes it as much deeper as the place that is deepest is away from the shoulder: more than the elbow is,
/// less than the wrist. Over 8°, because the wrist hangs beside the hip, where the trunk's part ends, and there another
/// vertex may come inside from one degree to the next.
TEST(SelfPenetration, AForearmPressedIntoTheTrunkGoesAsDeepAsItsAngleSays) {
  const BodyModel& body = BuiltinBody();
  const std::vector<std::string> names = PartsOfBody(body).names;
  const size_t P = names.size();
  const auto part = [&](const char* name) {
    return size_t(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const auto pressed = [&](double deg) {
    const FramePenetration frame = Measure(body, OnePose(24, 16, Vector3d(0, 0, -deg * std::numbers::pi / 180)));
    return frame.deepest_of_pair_m[part("l_forearm") * P + part("trunk")];
  };
  EXPECT_EQ(pressed(84), 0);
  const auto from_shoulder = [&](const char* joint) {
    return (body.joint_template().row(body.FindJoint(joint)) - body.joint_template().row(body.FindJoint("l_shoulder")))
        .norm();
  };
  for (double deg = 86; deg <= 90; deg += 2) {
    const double lever_m = (pressed(deg + 8) - pressed(deg)) / (8 * std::numbers::pi / 180);
    EXPECT_GT(lever_m, from_shoulder("l_elbow")) << deg << " degrees";
    EXPECT_LT(lever_m, 1.05 * from_shoulder("l_wrist")) << deg << " degrees";
  }
}

TEST(SelfPenetration, FiguresOfAnEvaluation) {
  SelfPenetration penetration;
  penetration.parts = {"a", "b"};
  penetration.num_vertices = 200;
  for (const double mm : {0.0, 8.0, 12.0, 20.0}) {
    FramePenetration frame;
    frame.deepest_m = mm / 1000;
    frame.vertices = mm > 0 ? 10 : 0;
    frame.deepest_of_pair_m = {0, 0, mm / 1000, 0};
    penetration.frames.push_back(frame);
  }
  Evaluation e;
  AddSelfPenetration(penetration, "", &e);
  AddSelfPenetration(penetration, "gt_", &e);
  EXPECT_NEAR(e.Value("self_penetration_mm"), 10, 1e-12);
  EXPECT_NEAR(e.Value("self_penetration_p95_mm"), 12 + 0.85 * 8, 1e-12);
  EXPECT_NEAR(e.Value("self_penetration_frames_percent"), 50, 1e-12);
  EXPECT_NEAR(e.Value("self_penetration_vertices_percent"), 3.75, 1e-12);
  EXPECT_NEAR(e.Value("gt_self_penetration_mm"), 10, 1e-12);
  ASSERT_EQ(e.breakdowns.size(), 1u);
  EXPECT_EQ(e.breakdowns[0].labels, std::vector<std::string>{"b in a"});
  EXPECT_NEAR(e.breakdowns[0].values[0], 10, 1e-12);

  Evaluation none;
  AddSelfPenetration({{"a"}, {}, 10}, "", &none);
  EXPECT_TRUE(std::isnan(none.Value("self_penetration_mm")));
  EXPECT_TRUE(std::isnan(none.Value("self_penetration_frames_percent")));
  EXPECT_TRUE(none.breakdowns.empty());
}

TEST(SelfPenetration, LostFramesAreLeftOutAndWrongArgumentsRefused) {
  Motion motion = BadPoses();
  motion.poses(2, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MeasureSelfPenetration(motion, {1, 2, 3}, BuiltinBody()).frames.size(), 2u);
  EXPECT_THROW(MeasureSelfPenetration(motion, {6}, BuiltinBody()), std::invalid_argument);
  EXPECT_THROW(MeasureSelfPenetration(motion, {0}, BuiltinBody(), {.other_share = -1}), std::invalid_argument);
  EXPECT_TRUE(MeasureSelfPenetration(motion, {}, BuiltinBody()).frames.empty());
}

}  // namespace
}  // namespace bodyloom::self_penetration_test
