// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/body_with_garment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/skinning.h"
#include "geometry/cloth/body_obstacles.h"

namespace bodyloom {
namespace {

constexpr double kReach_m = 0.1;      ///< σ of the weights
constexpr float kMarginOfUv = 0.02F;  ///< around the garment's rectangle
constexpr double kMinWeight = 1e-3;

/// J weights for a vertex of the garment, of which vertices of the body.
Eigen::VectorXd WeightsNear(const BodyModel& body, const std::vector<int>& vertices, const Eigen::RowVector3d& place) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(body.num_joints());
  const double nearest2 =
      (body.data().v_template(vertices, Eigen::all).rowwise() - place).rowwise().squaredNorm().minCoeff();
  for (const int v : vertices) {
    const double distance2 = (body.data().v_template.row(v) - place).squaredNorm();
    const double share = std::exp((nearest2 - distance2) / (2 * kReach_m * kReach_m));
    for (int i = body.influence_begin()[v]; i < body.influence_begin()[v + 1]; ++i) {
      const int joint = body.influence_joint()[i];
      if (IsOfTrunkOrLegs(joint)) weights[joint] += share * body.influence_weight()[i];
    }
  }
  weights /= weights.sum();
  weights = (weights.array() > kMinWeight).select(weights, 0).eval();
  return weights / weights.sum();
}

SparseRows FromTriplets(Eigen::Index rows, Eigen::Index columns, const std::vector<Eigen::Triplet<double>>& entries) {
  SparseRows matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<Eigen::Triplet<double>> TripletsOf(const SparseRows& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < matrix.outerSize(); ++row) {
    for (SparseRows::InnerIterator it(matrix, row); it; ++it) {
      entries.emplace_back(it.row(), it.col(), it.value());
    }
  }
  return entries;
}

template <typename Matrix>
Matrix Extended(const Matrix& top, Eigen::Index rows) {
  Matrix both = Matrix::Zero(top.rows() + rows, top.cols());
  both.topRows(top.rows()) = top;
  return both;
}

}  // namespace

BodyModelData BodyWithGarment(const BodyModel& body, const LooseGarment& garment) {
  BODYLOOM_CHECK(body.num_joints() >= 24, "a garment needs a body on SMPL's 24 joints, this one has ",
                 body.num_joints());
  BodyModelData data = body.data();
  const int V = body.num_vertices(), F = body.num_faces(), D = static_cast<int>(garment.drawn_from.size());
  const auto garment_faces = static_cast<int>(garment.drawn_faces.rows());
  data.v_template = Extended(data.v_template, D);
  data.faces = Extended(data.faces, garment_faces);
  data.faces.bottomRows(garment_faces) = garment.drawn_faces.array() + V;
  data.shapedirs = Extended(data.shapedirs, 3 * D);
  if (!data.posedirs.begin.empty()) data.posedirs.begin.resize(V + D + 1, data.posedirs.begin.back());

  const std::vector<int> strongest = StrongestJoints(body);
  std::vector<int> near;
  for (int v = 0; v < V; ++v) {
    if (IsOfTrunkOrLegs(strongest[v])) near.push_back(v);
  }
  std::vector<Eigen::Triplet<double>> weights = TripletsOf(data.weights);
  for (int d = 0; d < D; ++d) {
    data.v_template.row(V + d) = garment.sewn[garment.drawn_from[d]].transpose();
    const Eigen::VectorXd of_vertex = WeightsNear(body, near, data.v_template.row(V + d));
    for (int j = 0; j < of_vertex.size(); ++j) {
      if (of_vertex[j] > 0) weights.emplace_back(V + d, j, of_vertex[j]);
    }
  }
  data.weights = FromTriplets(V + D, body.num_joints(), weights);
  data.J_regressor = FromTriplets(data.J_regressor.rows(), V + D, TripletsOf(data.J_regressor));

  if (body.has_uv()) {
    const Eigen::Index before = data.vt.rows();
    data.vt.col(1) *= float(kBodyShareOfV);
    data.vt = Extended(data.vt, D);
    const float length = garment.pattern.col(1).maxCoeff();
    const float low = float(kBodyShareOfV) + kMarginOfUv, high = 1 - kMarginOfUv;
    for (int d = 0; d < D; ++d) {
      data.vt(before + d, 0) =
          kMarginOfUv + (1 - 2 * kMarginOfUv) * garment.pattern(d, 0) / static_cast<float>(garment.around_m);
      data.vt(before + d, 1) = high - (high - low) * garment.pattern(d, 1) / length;
    }
    data.ft = Extended(data.ft, garment_faces);
    data.ft.bottomRows(garment_faces) = garment.drawn_faces.array() + static_cast<int>(before);
  }
  if (body.has_parts()) data.face_part.resize(F + garment_faces, 0);
  if (data.face_iuv.rows() > 0) data.face_iuv = Extended(data.face_iuv, garment_faces);
  return data;
}

BodyModelData BodyWithoutGarment(const BodyModel& both, int num_vertices) {
  BODYLOOM_CHECK(num_vertices > 0 && num_vertices <= both.num_vertices(), num_vertices, " vertices of a body of ",
                 both.num_vertices());
  BodyModelData data = both.data();
  int faces = 0;
  while (faces < data.faces.rows() && data.faces.row(faces).maxCoeff() < num_vertices) ++faces;
  BODYLOOM_CHECK(
      faces == data.faces.rows() || data.faces.bottomRows(data.faces.rows() - faces).minCoeff() >= num_vertices,
      "a body with a garment: faces of both are mixed at face ", faces);
  data.v_template = data.v_template.topRows(num_vertices).eval();
  data.faces = data.faces.topRows(faces).eval();
  data.shapedirs = data.shapedirs.topRows(3 * num_vertices).eval();
  if (!data.posedirs.begin.empty()) {
    data.posedirs.begin.resize(num_vertices + 1);
    data.posedirs.joint.resize(data.posedirs.begin.back());
    data.posedirs.block.resize(size_t(27) * data.posedirs.begin.back());
  }
  std::vector<Eigen::Triplet<double>> weights = TripletsOf(data.weights);
  std::erase_if(weights, [&](const Eigen::Triplet<double>& entry) { return entry.row() >= num_vertices; });
  data.weights = FromTriplets(num_vertices, both.num_joints(), weights);
  const std::vector<Eigen::Triplet<double>> regressors = TripletsOf(data.J_regressor);
  for (const Eigen::Triplet<double>& entry : regressors) {
    BODYLOOM_CHECK(entry.col() < num_vertices, "a body with a garment: joint ", entry.row(), " hangs on the garment");
  }
  data.J_regressor = FromTriplets(data.J_regressor.rows(), num_vertices, regressors);
  if (both.has_uv()) data.ft = data.ft.topRows(faces).eval();
  if (both.has_parts()) data.face_part.resize(faces);
  if (data.face_iuv.rows() > 0) data.face_iuv = data.face_iuv.topRows(faces).eval();
  return data;
}

void PlaceGarment(const LooseGarment& garment, std::span<const Eigen::Vector3d> cloth, MatrixX3d* vertices_of_both) {
  const auto drawn = static_cast<Eigen::Index>(garment.drawn_from.size());
  BODYLOOM_CHECK(cloth.size() == garment.sewn.size() && vertices_of_both->rows() >= drawn, cloth.size(),
                 " places of cloth for a garment of ", garment.sewn.size(), " vertices");
  const Eigen::Index first = vertices_of_both->rows() - drawn;
  for (Eigen::Index d = 0; d < drawn; ++d) vertices_of_both->row(first + d) = cloth[garment.drawn_from[d]].transpose();
}

}  // namespace bodyloom
