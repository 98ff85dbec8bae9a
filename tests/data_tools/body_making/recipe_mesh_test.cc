// SPDX-License-Identifier: Apache-2.0
/// Promises of assets/body/RECIPE.md, sections 1 and 2: the mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "data_tools/body_making/cage.h"
#include "data_tools/body_making/make_builtin_body.h"
#include "data_tools/formats/npz.h"
#include "tests/data_tools/body_making/openmesh_catmull_clark.h"
#include "tests/data_tools/body_making/recipe_support.h"
#include "tests/support/paths.h"

namespace bodyloom::recipe_mesh_test {
namespace {

/// One number for an array that notices a change of any coordinate: Σ sin(0.7371 i + phase) x_i.
template <typename Array>
double Fingerprint(const Array& values, Eigen::Index stride, Eigen::Index count, double phase) {
  double sum = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    sum += std::sin(0.7371 * static_cast<double>(i) + phase) * static_cast<double>(values.data()[i * stride]);
  }
  return sum;
}

/// A piecewise linear map, averaged over ±3 cm.
double Stretched(double x, const std::vector<double>& from, const std::vector<double>& to) {
  double sum = 0;
  for (int k = -20; k <= 20; ++k) {
    const double at = x + 0.03 * k / 20;
    size_t i = 1;
    while (i + 1 < from.size() && at > from[i]) ++i;
    sum += to[i - 1] + (to[i] - to[i - 1]) * (at - from[i - 1]) / (from[i] - from[i - 1]);
  }
  return sum / 41;
}

/// Section 6's maps: legs by .98 and .961, arms by 1.043 and 1.04, everything by 1.0145 about the new pelvis.
MatrixX3d WithProportions(MatrixX3d v) {
  constexpr double kHip = -0.0808, kKnee = -0.4721, kAnkle = -0.8998, kShoulder = 0.1771, kElbow = 0.4225,
                   kWrist = 0.6629;
  constexpr double kScale = 1.014504293, kPelvis = 0.000292841;
  const double knee = kHip + 0.98 * (kKnee - kHip), ankle = knee + 0.961 * (kAnkle - kKnee);
  const double elbow = kShoulder + 1.043 * (kElbow - kShoulder), wrist = elbow + 1.04 * (kWrist - kElbow);
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    const double x = std::abs(v(i, 0)), y = v(i, 1);
    if (x > kShoulder - 0.03 && y > 0.25) {
      v(i, 0) = std::copysign(
          Stretched(x, {0, kShoulder, kElbow, kWrist, 1}, {0, kShoulder, elbow, wrist, wrist + 1 - kWrist}), v(i, 0));
    }
    v(i, 1) = Stretched(y, {-1, kAnkle, kKnee, kHip, 1}, {ankle - 1 - kAnkle, ankle, knee, kHip, 1}) - kPelvis;
  }
  return kScale * v;
}

TEST(RecipeMesh, Counts) {
  const BodyModel& body = BuiltinBody();
  EXPECT_EQ(body.name(), "bodyloom");
  EXPECT_EQ(body.num_vertices(), 7874);
  EXPECT_EQ(body.num_faces(), 15744);
  EXPECT_EQ(body.num_joints(), 24);
  EXPECT_EQ(body.num_betas(), 10);
  const Cage cage = ParseCage(EmbeddedBuiltinBodySources().cage_text, "cage");
  EXPECT_EQ(cage.vertices.rows(), 494);
  EXPECT_EQ(cage.quads.size(), 492u);
  EXPECT_EQ(cage.num_left_vertices, 261);
  EXPECT_EQ(cage.num_left_quads, 246);
}

TEST(RecipeMesh, CageValences) {
  const Cage cage = ParseCage(EmbeddedBuiltinBodySources().cage_text, "cage");
  std::vector<int> valence(cage.vertices.rows(), 0);
  for (const Quad& quad : cage.quads) {
    for (int v : quad) ++valence[v];  // closed manifold: as many quads as edges around a vertex
  }
  std::map<int, int> histogram;
  for (int n : valence) ++histogram[n];
  EXPECT_EQ(histogram, (std::map<int, int>{{3, 58}, {4, 404}, {5, 14}, {6, 18}}));
}

TEST(RecipeMesh, AllQuads) {
  const MatrixX3i& faces = BuiltinBody().data().faces;
  std::set<std::set<int>> quads;
  for (Eigen::Index f = 0; f < faces.rows(); f += 2) {
    EXPECT_EQ(faces(f, 0), faces(f + 1, 0));
    EXPECT_EQ(faces(f, 2), faces(f + 1, 1));
    const std::set<int> corners = {faces(f, 0), faces(f, 1), faces(f, 2), faces(f + 1, 2)};
    EXPECT_EQ(corners.size(), 4u) << "quad " << f / 2;
    quads.insert(corners);
  }
  EXPECT_EQ(quads.size(), 7872u);
}

TEST(RecipeMesh, ClosedOrientedManifoldOfEulerCharacteristicTwo) {
  const BodyModel& body = BuiltinBody();
  std::set<std::pair<int, int>> directed;
  for (Eigen::Index f = 0; f < body.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto edge = std::pair(body.data().faces(f, k), body.data().faces(f, (k + 1) % 3));
      EXPECT_TRUE(directed.insert(edge).second) << edge.first << "->" << edge.second << " twice";
    }
  }
  for (const auto& [a, b] : directed) EXPECT_TRUE(directed.contains({b, a})) << a << "-" << b << " is a boundary";
  EXPECT_EQ(body.num_vertices() - static_cast<int>(directed.size()) / 2 + body.num_faces(), 2);
  // One component, and around each vertex one fan: otherwise χ = 2 would not mean a sphere.
  std::map<int, std::map<int, int>> next_around;
  for (Eigen::Index f = 0; f < body.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      next_around[body.data().faces(f, k)][body.data().faces(f, (k + 1) % 3)] = body.data().faces(f, (k + 2) % 3);
    }
  }
  ASSERT_EQ(static_cast<int>(next_around.size()), body.num_vertices());
  for (auto& [v, ring] : next_around) {
    size_t steps = 1;
    const int start = ring.begin()->first;
    for (int at = ring.at(start); at != start && steps <= ring.size(); at = ring.at(at)) ++steps;
    EXPECT_EQ(steps, ring.size()) << "vertex " << v << " joins two fans";
  }
  std::set<int> reached = {0};
  std::vector<int> front = {0};
  while (!front.empty()) {
    const int v = front.back();
    front.pop_back();
    for (const auto& [neighbour, unused] : next_around[v]) {
      if (reached.insert(neighbour).second) front.push_back(neighbour);
    }
  }
  EXPECT_EQ(static_cast<int>(reached.size()), body.num_vertices());
}

TEST(RecipeMesh, MirrorSymmetric) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d& v = body.data().v_template;
  const std::vector<int> mirror = MirrorByPosition(v);
  std::set<std::array<int, 3>> faces;
  const auto canonical = [](std::array<int, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  for (Eigen::Index f = 0; f < body.num_faces(); ++f) {
    faces.insert(canonical({body.data().faces(f, 0), body.data().faces(f, 1), body.data().faces(f, 2)}));
  }
  for (int i = 0; i < body.num_vertices(); ++i) {
    ASSERT_GE(mirror[i], 0) << "vertex " << i;
    EXPECT_LT((v.row(mirror[i]) - v.row(i).cwiseProduct(Eigen::RowVector3d(-1, 1, 1))).norm(), 1e-15);
    for (int c = 0; c < 3; ++c) {
      const Eigen::RowVectorXf expected = (c == 0 ? -1.0f : 1.0f) * body.data().shapedirs.row(3 * i + c);
      EXPECT_LT((body.data().shapedirs.row(3 * mirror[i] + c) - expected).cwiseAbs().maxCoeff(), 1e-7f) << i;
    }
  }
  for (const auto& t : faces) {
    EXPECT_TRUE(faces.contains(canonical({mirror[t[0]], mirror[t[2]], mirror[t[1]]})));
  }
}

TEST(RecipeMesh, Measures) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d& v = body.data().v_template;
  const Eigen::RowVector3d low = v.colwise().minCoeff(), high = v.colwise().maxCoeff();
  EXPECT_NEAR(high.y() - low.y(), 1.712, 0.0005);
  EXPECT_NEAR(high.x() - low.x(), 1.770, 0.0005);
  EXPECT_NEAR(low.y(), -0.962, 0.0006);
  EXPECT_NEAR(high.y(), 0.750, 0.0005);
  EXPECT_NEAR(MeshVolume(v, body.data().faces), 0.0687, 0.00005);
  EXPECT_NEAR(MeshArea(v, body.data().faces), 1.757, 0.0005);
  EXPECT_LT(body.joint_template().row(0).norm(), 1e-6) << "the regressed pelvis is the origin";
  // Front is +z: the nose is in front of the head joint, the toes are in front of the ankle.
  const MatrixX3d points = PoseLandmarks(body, {}, PoseFromAxisAngle(body, Eigen::VectorXd(), {0, 0, 0}),
                                         {"nose", "left_big_toe", "left_ear"});
  EXPECT_GT(points(0, 2), body.joint_template()(body.FindJoint("head"), 2) + 0.05);
  EXPECT_GT(points(1, 2), body.joint_template()(body.FindJoint("l_ankle"), 2) + 0.1);
  EXPECT_GT(points(2, 0), 0.05) << "x is the body's left";
}

/// The numbers were computed from the finished body's own arrays, stored apart from the cage.
TEST(RecipeMesh, SubdivisionGivesTheFinishedBody) {
  const BodyModelData& data = BuiltinBody().data();
  const double expected_template[3] = {2.194787835137, 1.666687418926, -0.393757723921};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(Fingerprint(data.v_template, 1, data.v_template.size(), k), expected_template[k], 1e-6) << k;
  }
  EXPECT_LT((data.v_template.row(4000) - Eigen::RowVector3d(4.672670390e-02, 2.034667819e-03, 1.579198873e-01)).norm(),
            1e-8);
  EXPECT_LT(
      (data.v_template.row(7873) - Eigen::RowVector3d(-1.312274903e-01, -9.466571767e-01, 1.791007569e-01)).norm(),
      1e-8);
  const double expected_shape[10] = {0.153680309,  -0.012881459, 0.073067617,  -0.035922410, 0.011503586,
                                     -0.029324423, -0.037383493, -0.030916196, 0.030937146,  -0.028413548};
  for (int b = 0; b < 10; ++b) {
    const RowMatrixXf column = data.shapedirs.col(b);
    // The finished arrays are rounded to 1e-6 m: 23,622 rounding errors add up to about 3e-5.
    EXPECT_NEAR(Fingerprint(column, 1, column.rows(), b), expected_shape[b], 1e-4) << b;
  }
}

TEST(RecipeMesh, OpenMeshAgrees) {
  const BuiltinBodySources sources = EmbeddedBuiltinBodySources();
  MakeBuiltinBodySummary summary;
  const BodyModelData body = MakeBuiltinBody(sources, &summary);
  QuadMesh made{body.v_template, {}};
  for (Eigen::Index f = 0; f < body.faces.rows(); f += 2) {
    made.quads.push_back({body.faces(f, 0), body.faces(f, 1), body.faces(f, 2), body.faces(f + 1, 2)});
  }
  const Cage cage = ParseCage(sources.cage_text, sources.cage_name);
  const MeshAgreement agreement = CompareByGeometry(made, SubdivideByOpenMesh({cage.vertices, cage.quads}, 2), 1e-6);
  EXPECT_TRUE(agreement.Equal()) << agreement.BriefReport();
  EXPECT_LT(agreement.max_vertex_distance_m, 1e-14);
  EXPECT_EQ(summary.cage_vertices, 494);
  EXPECT_EQ(summary.cage_quads, 492);
  EXPECT_EQ(summary.vertices, 7874);
  EXPECT_EQ(summary.quads, 7872);
}

/// Every array against the finished body as it was first made, where that file is at hand.
TEST(RecipeMesh, EqualsTheOriginalFile) {
  const std::string path = SharedDir() + "/assets/body/body.npz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the original body.npz is not at " << path;
  const NpzArrays original = ReadNpz(path);
  const BodyModelData& data = BuiltinBody().data();
  // The cage was stretched since (RECIPE.md, "Proportions"); its subdivision is not quite the stretched surface.
  const MatrixX3d stretched = WithProportions(RequireArray(original, "v_template", path).ToMatrix());
  EXPECT_LT((stretched - data.v_template).rowwise().norm().maxCoeff(), 0.001);
  const std::vector<float> shapedirs = RequireArray(original, "shapedirs", path).ToFloats();
  const Eigen::Map<const RowMatrixXf> original_shape(shapedirs.data(), 3 * data.v_template.rows(), 10);
  EXPECT_LT((original_shape - data.shapedirs).cwiseAbs().maxCoeff(), 1e-6f);
  EXPECT_EQ(RequireArray(original, "f", path).ToMatrix(), data.faces.cast<double>());
  // Weights are stored in steps of 1/65535; a row's largest absorbs the rounding of the others.
  EXPECT_LT((RequireArray(original, "weights", path).ToMatrix() - RowMatrixXd(data.weights)).cwiseAbs().maxCoeff(),
            2e-5);
  EXPECT_LT(
      (RequireArray(original, "J_regressor", path).ToMatrix() - RowMatrixXd(data.J_regressor)).cwiseAbs().maxCoeff(),
      1e-7);
  // Charts: the same faces in the same parts but for the arms, whose halves are now inner/outer (RECIPE.md, section 8).
  const std::vector<int64_t> part = RequireArray(original, "part", path).ToInts();
  const std::vector<float> iuv = RequireArray(original, "iu_uv", path).ToFloats();
  for (size_t f = 0; f < part.size(); ++f) {
    const auto limb = [](int64_t id) { return 2 * ((id - 15) / 4) + (id - 15) % 2; };  // of the arm parts 15..22
    if (part[f] >= 15 && part[f] <= 22) {
      EXPECT_EQ(limb(data.face_part[f]), limb(part[f])) << "face " << f;
      continue;
    }
    ASSERT_EQ(int{data.face_part[f]}, part[f]) << "face " << f;
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(data.face_iuv(static_cast<Eigen::Index>(f), k), iuv[6 * f + k], 1e-5) << "face " << f;
  }
}

struct Measures {
  double height_m, volume_l, shoulder_breadth_m, hip_breadth_m, waist_breadth_m, leg_length_m, arm_span_m;
};

double BreadthAt(const MatrixX3d& vertices, double low_y, double high_y, double max_abs_x) {
  double breadth = 0;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    const double x = std::abs(vertices(v, 0));
    if (vertices(v, 1) > low_y && vertices(v, 1) < high_y && x < max_abs_x) breadth = std::max(breadth, 2 * x);
  }
  return breadth;
}

Measures Measure(const Eigen::VectorXd& betas) {
  const BodyModel& body = BuiltinBody();
  const MatrixX3d v = ShapeVertices(body, betas);
  const MatrixX3d joints = body.RestJoints(betas);
  const auto joint = [&](const char* name) { return Eigen::RowVector3d(joints.row(body.FindJoint(name))); };
  Measures m;
  m.height_m = v.col(1).maxCoeff() - v.col(1).minCoeff();
  m.volume_l = 1000 * MeshVolume(v, body.data().faces);
  m.shoulder_breadth_m = 2 * joint("l_shoulder").x();
  m.hip_breadth_m = BreadthAt(v, joint("l_hip").y() - 0.03, joint("l_hip").y() + 0.03, 0.3);
  m.waist_breadth_m = BreadthAt(v, joint("spine1").y() - 0.03, joint("spine1").y() + 0.03, 0.3);
  m.arm_span_m = v.col(0).maxCoeff() - v.col(0).minCoeff();
  m.leg_length_m = joint("l_hip").y() - joint("l_ankle").y();
  return m;
}

// Properties promised by assets/body/RECIPE.md, section 5: meaning of the shape components.

TEST(RecipeShape, StatureOfTheFirstComponent) {
  const Measures tall = Measure(OneBeta(0, 2)), small = Measure(OneBeta(0, -2));
  EXPECT_NEAR(tall.height_m, 1.895, 0.001);
  EXPECT_NEAR(tall.volume_l, 96, 0.5);
  EXPECT_NEAR(small.height_m, 1.530, 0.001);
  EXPECT_NEAR(small.volume_l, 48, 0.5);
}

TEST(RecipeShape, SexAtFixedStatureOfTheSecond) {
  const Measures male = Measure(OneBeta(1, 2)), female = Measure(OneBeta(1, -2));
  EXPECT_GT(male.shoulder_breadth_m, female.shoulder_breadth_m + 0.01);
  EXPECT_LT(male.hip_breadth_m, female.hip_breadth_m - 0.01);
  EXPECT_GT(male.arm_span_m, female.arm_span_m + 0.05);
  EXPECT_NEAR(male.leg_length_m - female.leg_length_m, 0.013, 0.002);
  EXPECT_LT(std::abs(male.height_m - female.height_m), 0.05) << "stature is the first component's";
}

TEST(RecipeShape, WeightOfTheThird) {
  const Measures heavy = Measure(OneBeta(2, 2)), light = Measure(OneBeta(2, -2));
  EXPECT_NEAR(light.volume_l, 50, 0.7);
  EXPECT_NEAR(heavy.volume_l, 90, 0.7);
  EXPECT_GT(heavy.waist_breadth_m, light.waist_breadth_m + 0.05);
  EXPECT_LT(std::abs(heavy.height_m - light.height_m), 0.05);
}

TEST(RecipeShape, AgeAndProportions) {
  const Measures old = Measure(OneBeta(3, 2)), young = Measure(OneBeta(3, -2));
  EXPECT_GT(old.waist_breadth_m, young.waist_breadth_m);
  const Measures ideal = Measure(OneBeta(4, 2)), other = Measure(OneBeta(4, -2));
  EXPECT_LT(ideal.waist_breadth_m, other.waist_breadth_m);
}

/// Components are principal axes in units of one standard deviation: mutually orthogonal under the area of the mean
/// body, and their squared lengths are shares of the population's variance. The recipe's cumulative shares, %:
TEST(RecipeShape, VarianceShares) {
  const BodyModelData& data = BuiltinBody().data();
  const Eigen::VectorXd areas = VertexAreas(data.v_template, data.faces);
  Eigen::MatrixXd weighted = data.shapedirs.cast<double>();
  for (Eigen::Index v = 0; v < areas.size(); ++v) weighted.middleRows<3>(3 * v) *= std::sqrt(areas[v] / areas.sum());
  const Eigen::MatrixXd gram = weighted.transpose() * weighted;
  const double cumulative[10] = {81.0, 88.4, 93.9, 95.9, 97.0, 98.0, 98.5, 98.9, 99.1, 99.3};
  const double all = gram.trace() / (cumulative[9] / 100);
  double sum = 0;
  for (int b = 0; b < 10; ++b) {
    sum += gram(b, b);
    EXPECT_NEAR(100 * sum / all, cumulative[b], 0.35) << "component " << b;
    EXPECT_TRUE(b == 0 || gram(b, b) < gram(b - 1, b - 1)) << "component " << b;
    for (int c = 0; c < b; ++c) {
      EXPECT_LT(std::abs(gram(b, c)) / std::sqrt(gram(b, b) * gram(c, c)), 0.05) << b << " and " << c;
    }
  }
}

}  // namespace

}  // namespace bodyloom::recipe_mesh_test
