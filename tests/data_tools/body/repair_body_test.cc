// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/repair_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "data_tools/body/builtin_body.h"
#include "geometry/body/posed_body.h"
#include "geometry/mesh/mesh_check.h"
#include "tests/support/toy_body.h"

namespace bodyloom::repair_body_test {
namespace {

CheckMeshResult Check(const BodyModelData& body) { return CheckMesh(body.v_template, body.faces); }

void AppendFace(int like, const Eigen::RowVector3i& corners, BodyModelData* body) {
  const Eigen::Index f = body->faces.rows();
  body->faces.conservativeResize(f + 1, 3);
  body->faces.row(f) = corners;
  body->ft.conservativeResize(f + 1, 3);
  body->ft.row(f) = body->ft.row(like).eval();
  body->face_iuv.conservativeResize(f + 1, 6);
  body->face_iuv.row(f) = body->face_iuv.row(like).eval();
  body->face_part.push_back(body->face_part[like]);
}

/// Gives the body copies of vertices, which nothing names yet; the number of the first.
int AppendVertices(const std::vector<int>& of, BodyModelData* body) {
  const auto V = static_cast<int>(body->v_template.rows()), n = static_cast<int>(of.size());
  body->v_template.conservativeResize(V + n, 3);
  body->shapedirs.conservativeResize(3 * (V + n), body->shapedirs.cols());
  SparseRows weights(V + n, body->weights.cols()), regressor(body->J_regressor.rows(), V + n);
  std::vector<Eigen::Triplet<double>> entries;
  PoseCorrectives& p = body->posedirs;
  for (int v = 0; v < V + n; ++v) {
    const int source = v < V ? v : of[v - V];
    for (SparseRows::InnerIterator it(body->weights, source); it; ++it) {
      entries.emplace_back(v, static_cast<int>(it.col()), it.value());
    }
    if (v < V) continue;
    body->v_template.row(v) = body->v_template.row(source).eval();
    body->shapedirs.middleRows<3>(3 * v) = body->shapedirs.middleRows<3>(3 * source).eval();
    for (int k = p.begin[source]; k < p.begin[source + 1]; ++k) {
      p.joint.push_back(p.joint[k]);
      for (int i = 0; i < 27; ++i) p.block.push_back(p.block[27 * size_t(k) + i]);
    }
    p.begin.push_back(static_cast<int>(p.joint.size()));
  }
  weights.setFromTriplets(entries.begin(), entries.end());
  body->weights = weights;
  entries.clear();
  for (int j = 0; j < body->J_regressor.rows(); ++j) {
    for (SparseRows::InnerIterator it(body->J_regressor, j); it; ++it) {
      entries.emplace_back(j, static_cast<int>(it.col()), it.value());
    }
  }
  regressor.setFromTriplets(entries.begin(), entries.end());
  body->J_regressor = regressor;
  return V;
}
int AppendVertex(int of, BodyModelData* body) { return AppendVertices({of}, body); }

MatrixX3d Posed(const BodyModelData& data) {
  const BodyModel body(data);
  Eigen::VectorXd betas(body.num_betas()), pose(3 * body.num_joints());
  for (int i = 0; i < betas.size(); ++i) betas[i] = std::sin(1.0 + i);
  for (int i = 0; i < pose.size(); ++i) pose[i] = 0.4 * std::sin(0.7 * i);
  return PoseVertices(body, betas, PoseFromAxisAngle(body, pose, {0.1, 0.2, 3}));
}

TEST(RepairBody, LeavesACleanBodyAlone) {
  BodyModelData body = BuiltinBody().data();
  EXPECT_TRUE(Check(body).IsClean());
  const RepairBodySummary summary = RepairBody({}, &body);
  EXPECT_FALSE(summary.changed());
  EXPECT_EQ(body.faces, BuiltinBody().data().faces);
  EXPECT_EQ(body.v_template, BuiltinBody().data().v_template);
}

/// Everything that can be mended, at once: the result is the body that was damaged, in every array.
TEST(RepairBody, MendsADamagedBody) {
  const BodyModelData& whole = BuiltinBody().data();
  BodyModelData body = whole;
  for (const int f : {7, 8, 4000}) {  // turned
    std::swap(body.faces(f, 1), body.faces(f, 2));
    std::swap(body.ft(f, 1), body.ft(f, 2));
    for (int c = 0; c < 2; ++c) std::swap(body.face_iuv(f, 2 + c), body.face_iuv(f, 4 + c));
  }
  AppendFace(100, body.faces.row(100), &body);                                           // doubled
  AppendFace(200, {body.faces(200, 0), body.faces(200, 0), body.faces(200, 1)}, &body);  // a corner twice
  const int torn = body.faces(1234, 1), copy = AppendVertex(torn, &body);                // a seam of one vertex
  body.faces(1234, 1) = copy;
  AppendVertex(50, &body), AppendVertex(60, &body);  // in no face
  const CheckMeshResult found = Check(body);
  EXPECT_EQ(found.turned_faces.size(), 3u);
  EXPECT_EQ(found.duplicate_faces.size(), 1u);
  EXPECT_EQ(found.repeated_corner_faces.size(), 1u);
  EXPECT_EQ(found.unreferenced_vertices.size(), 2u);
  EXPECT_EQ(found.duplicate_vertices.size(), 3u);
  EXPECT_EQ(found.boundary_loops.size(), 1u);

  const RepairBodySummary summary = RepairBody({}, &body);
  EXPECT_EQ(summary.turned_faces, 3);
  EXPECT_EQ(summary.dropped_faces, 2);
  EXPECT_EQ(summary.merged_vertices, 1);
  EXPECT_EQ(summary.dropped_vertices, 2);
  EXPECT_EQ(summary.vertices_that_part, 0);
  EXPECT_EQ(summary.vertices_in_use, 0);
  EXPECT_EQ(summary.largest_merge_m, 0);
  EXPECT_TRUE(Check(body).IsClean());
  EXPECT_EQ(body.faces, whole.faces);
  EXPECT_EQ(body.ft, whole.ft);
  EXPECT_EQ(body.face_iuv, whole.face_iuv);
  EXPECT_EQ(body.face_part, whole.face_part);
  EXPECT_EQ(body.v_template, whole.v_template);
  EXPECT_EQ(body.shapedirs, whole.shapedirs);
  EXPECT_LT((Posed(body) - Posed(whole)).cwiseAbs().maxCoeff(), 1e-12);  // sums are normalised once more
}

/// Merging the ends of a face's edge leaves it with a corner twice, and its third vertex with no face.
TEST(RepairBody, MendsWhatMendingBrings) {
  const BodyModelData& whole = BuiltinBody().data();
  BodyModelData body = whole;
  const int tip = AppendVertex(30, &body), copy = AppendVertex(40, &body);
  body.v_template(tip, 2) += 0.1;
  AppendFace(7, {40, copy, tip}, &body);
  const RepairBodySummary summary = RepairBody({}, &body);
  EXPECT_EQ(summary.merged_vertices, 1);
  EXPECT_EQ(summary.dropped_vertices, 1);
  EXPECT_EQ(summary.dropped_faces, 1);
  EXPECT_TRUE(Check(body).IsClean());
  EXPECT_EQ(body.faces, whole.faces);
}

/// Weights of joints and landmarks on a merged vertex move to the remaining vertex; lower indices come first.
TEST(RepairBody, JointsAndLandmarksKeepTheirPlace) {
  BodyModelData body = ToyBodyData();
  int nose = -1;
  for (const Landmark& landmark : body.landmarks) {
    if (landmark.name == "nose") nose = landmark.vertices[0];
  }
  const int copy = AppendVertex(nose, &body);
  const Eigen::MatrixXd joints = body.J_regressor * body.v_template;
  for (Landmark& landmark : body.landmarks) {
    if (landmark.name == "nose") landmark.vertices = {nose, copy}, landmark.weights = {0.25, 0.75};
  }
  for (SparseRows::InnerIterator it(body.J_regressor, 15); it; ++it) it.valueRef() *= 0.5;
  body.J_regressor.coeffRef(15, copy) = 0.5;
  const Eigen::RowVector3d head = body.J_regressor.row(15) * body.v_template;
  const RepairBodySummary summary = RepairBody({}, &body);
  EXPECT_EQ(summary.merged_vertices, 1);
  EXPECT_EQ(body.v_template.rows(), ToyBodyData().v_template.rows());
  EXPECT_LT((Eigen::RowVector3d(body.J_regressor.row(15) * body.v_template) - head).norm(), 1e-12);
  EXPECT_LT((Eigen::RowVector3d(body.J_regressor.row(3) * body.v_template) - joints.row(3)).norm(), 1e-12);
  for (const Landmark& landmark : body.landmarks) {
    if (landmark.name != "nose") continue;
    EXPECT_EQ(landmark.vertices, std::vector<int>{nose});
    EXPECT_EQ(landmark.weights, std::vector<double>{1.0});
  }
}

TEST(RepairBody, VerticesThatPartAreNotMerged) {
  const auto part = [](auto&& change) {
    BodyModelData body = BuiltinBody().data();
    const int vertex = body.faces(1234, 1), copy = AppendVertex(vertex, &body);
    body.faces(1234, 1) = copy;
    change(copy, &body);
    const RepairBodySummary summary = RepairBody({}, &body);
    EXPECT_EQ(summary.merged_vertices, 0);
    EXPECT_EQ(summary.vertices_that_part, 1);
    EXPECT_EQ(body.v_template.rows(), BuiltinBody().num_vertices() + 1);
    EXPECT_EQ(Check(body).boundary_loops.size(), 1u) << "still a seam";
  };
  part([](int copy, BodyModelData* body) { body->shapedirs(3 * copy + 1, 2) += 1e-3F; });
  part([](int copy, BodyModelData* body) {
    for (SparseRows::InnerIterator it(body->weights, copy); it; ++it) it.valueRef() = 0;
    body->weights.coeffRef(copy, 0) = 1;
  });
  part([](int copy, BodyModelData* body) {
    PoseCorrectives& p = body->posedirs;
    p.joint.push_back(3);
    p.block.resize(27 * p.joint.size(), 0);
    p.block.back() = 1e-3F;
    p.begin.back() = static_cast<int>(p.joint.size());
    EXPECT_EQ(copy + 2, static_cast<int>(p.begin.size()));
  });
}

TEST(RepairBody, MergesWithinATolerance) {
  BodyModelData body = BuiltinBody().data();
  const int vertex = body.faces(1234, 1), copy = AppendVertex(vertex, &body);
  body.faces(1234, 1) = copy;
  body.v_template(copy, 0) += 2e-5;
  BodyModelData exactly = body;
  EXPECT_EQ(RepairBody({}, &exactly).merged_vertices, 0);
  EXPECT_EQ(Check(exactly).boundary_loops.size(), 1u);
  RepairBodyOptions options;
  options.same_place_m = 5e-5;
  const RepairBodySummary summary = RepairBody(options, &body);
  EXPECT_EQ(summary.merged_vertices, 1);
  EXPECT_NEAR(summary.largest_merge_m, 2e-5, 1e-9);
  EXPECT_TRUE(Check(body).IsClean());
}

TEST(RepairBody, VerticesThatJointsNeedStay) {
  BodyModelData body = BuiltinBody().data();
  const int lone = AppendVertex(0, &body);
  body.v_template(lone, 1) += 0.5;
  for (SparseRows::InnerIterator it(body.J_regressor, 3); it; ++it) it.valueRef() *= 0.5;
  body.J_regressor.coeffRef(3, lone) = 0.5;
  const RepairBodySummary summary = RepairBody({}, &body);
  EXPECT_EQ(summary.dropped_vertices, 0);
  EXPECT_EQ(summary.vertices_in_use, 1);
  EXPECT_EQ(body.v_template.rows(), lone + 1);
}

TEST(RepairBody, VerticesOfAKnownTopologyKeepTheirNumbers) {
  BodyModelData body = BuiltinBody().data();
  AppendVertices(std::vector<int>(10475 - body.v_template.rows(), 17), &body);  // as many as SMPL-X has
  std::swap(body.faces(5, 1), body.faces(5, 2));
  const RepairBodySummary summary = RepairBody({}, &body);
  EXPECT_EQ(body.v_template.rows(), 10475);
  EXPECT_EQ(summary.merged_vertices + summary.dropped_vertices, 0);
  EXPECT_EQ(summary.vertices_numbered_elsewhere, 2 * (10475 - BuiltinBody().num_vertices()));
  EXPECT_EQ(summary.turned_faces, 1);
}

/// The body without face f, and with it appended again: what a hole of one face is filled with.
BodyModelData WithFaceFilled(int f, BodyModelData body) {
  const Eigen::RowVector3i corners = body.faces.row(f);
  const auto cut = [f](auto& rows) {
    const Eigen::Index n = rows.rows() - 1;
    if (n < 0) return;
    rows.middleRows(f, n - f) = rows.bottomRows(n - f).eval();
    rows.conservativeResize(n, rows.cols());
  };
  cut(body.faces), cut(body.ft), cut(body.face_iuv);
  body.face_part.erase(body.face_part.begin() + f);
  const MatrixX3i open = body.faces;
  RepairBodyOptions options;
  options.max_hole_edges = 17;
  options.hole_faces = [&](const MatrixX3d&, const MatrixX3i& faces, int max_edges) {
    EXPECT_EQ(faces, open);
    EXPECT_EQ(max_edges, 17);
    return MatrixX3i(corners);
  };
  const RepairBodySummary summary = RepairBody(options, &body);
  EXPECT_EQ(summary.filled_holes, 1);
  EXPECT_EQ(summary.added_faces, 1);
  EXPECT_TRUE(summary.changed());
  EXPECT_FALSE(summary.renumbered_vertices());
  return body;
}

/// Inside a chart the new face has the coordinates of the one that was there; beside a seam it spans no two charts.
TEST(RepairBody, AFilledHoleHasTheChartsOfTheFacesBeside) {
  const BodyModelData& whole = BuiltinBody().data();
  const Eigen::Index last = whole.faces.rows() - 1;
  std::map<int, std::set<int>> parts_of;  // by UV vertex
  std::map<std::pair<int, int>, std::vector<int>> faces_of;
  for (int f = 0; f <= last; ++f) {
    for (int k = 0; k < 3; ++k) {
      parts_of[whole.ft(f, k)].insert(whole.face_part[f]);
      faces_of[std::minmax(whole.faces(f, k), whole.faces(f, (k + 1) % 3))].push_back(f);
    }
  }
  int inside = 0, at_seams = 0;
  for (int f = 0; f <= last && (inside < 20 || at_seams < 20); f += 37) {
    bool is_inside = true;
    for (int k = 0; k < 3; ++k) {
      for (const int other : faces_of[std::minmax(whole.faces(f, k), whole.faces(f, (k + 1) % 3))]) {
        is_inside &= whole.face_part[other] == whole.face_part[f];
      }
    }
    if (++(is_inside ? inside : at_seams) > 20) continue;
    const BodyModelData body = WithFaceFilled(f, whole);
    ASSERT_EQ(body.faces.rows(), last + 1);
    EXPECT_EQ(body.faces.row(last), whole.faces.row(f));
    EXPECT_TRUE(Check(body).IsClean());
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(parts_of[body.ft(last, k)].count(body.face_part[last])) << "face " << f;
    if (!is_inside) continue;
    EXPECT_EQ(body.face_part[last], whole.face_part[f]);
    EXPECT_EQ(body.ft.row(last), whole.ft.row(f)) << "face " << f;
    EXPECT_EQ(body.face_iuv.row(last), whole.face_iuv.row(f)) << "face " << f;
  }
  EXPECT_GE(inside, 20);
  EXPECT_GE(at_seams, 20);
}

TEST(RepairBody, RefusesFacesThatCloseNoHole) {
  BodyModelData torn = BuiltinBody().data();
  const Eigen::Index F = torn.faces.rows() - 1;
  torn.faces.conservativeResize(F, 3), torn.ft.conservativeResize(F, 3), torn.face_iuv.conservativeResize(F, 6);
  torn.face_part.pop_back();
  const auto fill = [&](const Eigen::RowVector3i& face) {
    BodyModelData body = torn;
    RepairBodyOptions options;
    options.hole_faces = [&](const MatrixX3d&, const MatrixX3i&, int) { return MatrixX3i(face); };
    RepairBody(options, &body);
  };
  EXPECT_THROW(fill({0, 1, 7874}), std::invalid_argument);
  EXPECT_THROW(fill({-1, 1, 2}), std::invalid_argument);
  EXPECT_THROW(fill({5, 9, 5}), std::invalid_argument);
  EXPECT_THROW(fill({10, 3000, 6000}), std::invalid_argument) << "adjoins no face";
  EXPECT_NO_THROW(fill(BuiltinBody().data().faces.row(F)));
}

TEST(RepairBody, AMendedToyBodyPosesAsBefore) {
  BodyModelData body = ToyBodyData();
  const MatrixX3d before = Posed(body);
  AppendVertex(3, &body);
  AppendFace(9, body.faces.row(9), &body);
  RepairBody({}, &body);
  EXPECT_LT((Posed(body) - before).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(body.faces, ToyBodyData().faces);
}

}  // namespace
}  // namespace bodyloom::repair_body_test
