// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/repair_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "data_tools/body/body_landmarks.h"
#include "geometry/base/check.h"
#include "geometry/mesh/mesh_check.h"

namespace bodyloom {
namespace {

constexpr double kMaxStretch = 2;  // of a new edge's UV length a metre, in the model's

struct FaceCorner {
  int face = -1, corner = 0;
};

/// The faces that new ones may adjoin: those at their vertices.
class FaceAppender {
 public:
  FaceAppender(const MatrixX3i& added, BodyModelData* body) : body_(*body) {
    for (Eigen::Index i = 0; i < added.size(); ++i) corners_at_[added.data()[i]];
    for (int f = 0; f < body_.faces.rows(); ++f) Register(f);
  }

  /// Appends the face and returns true if it adjoins an existing one.
  bool Append(const Eigen::RowVector3i& face) {
    for (int k = 0; k < 3; ++k) {
      const auto model = face_at_.find(std::minmax(face[k], face[(k + 1) % 3]));
      if (model == face_at_.end()) continue;
      AppendBeside(face, k, model->second);
      return true;
    }
    return false;
  }

 private:
  void Register(int f) {
    for (int k = 0; k < 3; ++k) {
      const int a = body_.faces(f, k), b = body_.faces(f, (k + 1) % 3);
      const auto corners = corners_at_.find(a);
      if (corners == corners_at_.end()) continue;
      corners->second.push_back({f, k});
      if (corners_at_.contains(b)) face_at_.emplace(std::minmax(a, b), f);
    }
  }

  /// `k`: the edge of the face that it shares with its model.
  void AppendBeside(const Eigen::RowVector3i& face, int k, int model) {
    const auto f = static_cast<int>(body_.faces.rows());
    std::array<FaceCorner, 3> in_model;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (body_.faces(model, j) == face[i]) in_model[i] = {model, j};
      }
    }
    const int apex = (k + 2) % 3;
    const FaceCorner anchor = in_model[k];
    const bool has_apex = in_model[apex].face >= 0;
    Extend(face, &body_.faces);
    if (!body_.face_part.empty()) body_.face_part.push_back(body_.face_part[model]);
    if (body_.ft.rows() > 0) {
      const auto uv = [&](const FaceCorner& c) -> Eigen::RowVector2f {
        return body_.vt.row(body_.ft(c.face, c.corner));
      };
      if (!has_apex) in_model[apex] = Nearest(face[apex], anchor, uv);
      Eigen::RowVector3i row;
      for (int i = 0; i < 3; ++i) row[i] = body_.ft(in_model[i].face, in_model[i].corner);
      Extend(row, &body_.ft);
    }
    if (body_.face_iuv.rows() > 0) {
      const auto uv = [&](const FaceCorner& c) -> Eigen::RowVector2f {
        return body_.face_iuv.block<1, 2>(c.face, 2 * c.corner);
      };
      if (!has_apex) in_model[apex] = Nearest(face[apex], anchor, uv);
      Eigen::Matrix<float, 1, 6> row;
      for (int i = 0; i < 3; ++i) row.segment<2>(2 * i) = uv(in_model[i]);
      Extend(row, &body_.face_iuv);
    }
    Register(f);
  }

  /// The corner at `vertex` whose coordinates a face beside anchor's may take; anchor where there is none.
  template <typename CoordinatesOf>
  FaceCorner Nearest(int vertex, const FaceCorner& anchor, const CoordinatesOf& uv) const {
    const auto place = [&](const FaceCorner& c) { return body_.v_template.row(body_.faces(c.face, c.corner)); };
    double stretch = 0;  // UV length a metre
    for (int k = 0; k < 3; ++k) {
      const FaceCorner a{anchor.face, k}, b{anchor.face, (k + 1) % 3};
      const double metres = (place(a) - place(b)).norm();
      if (metres > 0) stretch = std::max(stretch, (uv(a) - uv(b)).norm() / metres);
    }
    double minimum = kMaxStretch * stretch * (body_.v_template.row(vertex) - place(anchor)).norm();
    FaceCorner nearest = anchor;
    for (const FaceCorner& corner : corners_at_.at(vertex)) {
      if (!body_.face_part.empty() && body_.face_part[corner.face] != body_.face_part[anchor.face]) continue;
      const double distance = (uv(corner) - uv(anchor)).norm();
      if (distance > minimum) continue;
      minimum = distance;
      nearest = corner;
    }
    return nearest;
  }

  template <typename Row, typename Matrix>
  static void Extend(const Row& row, Matrix* matrix) {
    matrix->conservativeResize(matrix->rows() + 1, row.cols());
    matrix->row(matrix->rows() - 1) = row;
  }

  BodyModelData& body_;
  std::map<int, std::vector<FaceCorner>> corners_at_;  // of vertices of the new faces
  std::map<std::pair<int, int>, int> face_at_;         // edge between two of them → its first face
};

/// Adds faces between existing vertices of a body, with part and texture coordinates.
/// Appends `faces` (N×3 vertices) to the body's. Each must share an edge with a face of the body, directly or through
/// others of `faces`; the first such face found is its model:
///
///   part               the model's
///   (u, v) of a vertex the model's, where the model has the vertex; otherwise, of those which the vertex has in faces
///                      of the same part, the nearest to the shared edge's, unless it lies further from there than
///                      twice the model's largest UV length a metre allows: then that of the shared edge, so that a
///                      face which would span two islands of the atlas covers no texel
///
/// This holds for texture coordinates (vt by ft) and coordinates inside a chart (face_iuv), if the body has them.
/// Throws std::invalid_argument on an index outside the vertices, a vertex named twice, or a face that adjoins none.
void AppendFaces(const MatrixX3i& faces, BodyModelData* body) {
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      BODYLOOM_CHECK(faces(f, k) >= 0 && faces(f, k) < body->v_template.rows(), "AppendFaces: face ", f,
                     " names vertex ", faces(f, k), ", expected 0..", body->v_template.rows() - 1);
      BODYLOOM_CHECK(faces(f, k) != faces(f, (k + 1) % 3), "AppendFaces: face ", f, " names vertex ", faces(f, k),
                     " twice");
    }
  }
  FaceAppender appender(faces, body);
  std::deque<int> waiting;  // for a face that they adjoin
  for (int f = 0; f < faces.rows(); ++f) waiting.push_back(f);
  for (size_t in_vain = 0; !waiting.empty();) {
    const int f = waiting.front();
    waiting.pop_front();
    if (appender.Append(faces.row(f))) {
      in_vain = 0;
      continue;
    }
    waiting.push_back(f);
    BODYLOOM_CHECK(++in_vain <= waiting.size(), "AppendFaces: face ", f, " adjoins no face of the body");
  }
}

constexpr double kMinTolerance = 1e-5;  // displacement that a compact file's grids may cause

/// Returns true if every unit of shape and pose displaces both vertices equally: no entries differ by more than
/// `tolerance`.
bool MoveAsOne(const BodyModelData& body, int a, int b, double tolerance) {
  for (int c = 0; c < 3 && body.shapedirs.cols() > 0; ++c) {
    const auto difference = body.shapedirs.row(3 * a + c) - body.shapedirs.row(3 * b + c);
    if (difference.cwiseAbs().maxCoeff() > tolerance) return false;
  }
  const auto differ = [&](const std::map<int, double>& entries) {
    return std::any_of(entries.begin(), entries.end(), [&](const auto& e) { return std::abs(e.second) > tolerance; });
  };
  std::map<int, double> weights;
  for (SparseRows::InnerIterator it(body.weights, a); it; ++it) weights[static_cast<int>(it.col())] += it.value();
  for (SparseRows::InnerIterator it(body.weights, b); it; ++it) weights[static_cast<int>(it.col())] -= it.value();
  if (differ(weights)) return false;
  std::map<int, double> correctives;  // 27 joint + entry
  const PoseCorrectives& p = body.posedirs;
  for (int side = 0; side < 2 && !p.empty(); ++side) {
    const int v = side == 0 ? a : b;
    for (int k = p.begin[v]; k < p.begin[v + 1]; ++k) {
      for (int i = 0; i < 27; ++i)
        correctives[27 * p.joint[k] + i] += (side == 0 ? 1 : -1) * p.block[27 * size_t(k) + i];
    }
  }
  return !differ(correctives);
}

/// Gives vertices their new numbers: `number[v]` of vertex v, −1 where it goes. Several vertices may get one number;
/// the first one is what the new vertex is made of.
void RenumberVertices(const std::vector<int>& number, int count, BodyModelData* body) {
  std::vector<int> source(count, -1);
  for (int v = static_cast<int>(number.size()) - 1; v >= 0; --v) {
    if (number[v] >= 0) source[number[v]] = v;
  }
  MatrixX3d v_template(count, 3);
  RowMatrixXf shapedirs(3 * count, body->shapedirs.cols());
  std::vector<Eigen::Triplet<double>> weights, regressor;
  PoseCorrectives posedirs;
  if (!body->posedirs.begin.empty()) posedirs.begin.push_back(0);
  for (int i = 0; i < count; ++i) {
    const int v = source[i];
    v_template.row(i) = body->v_template.row(v);
    if (shapedirs.cols() > 0) shapedirs.middleRows<3>(3 * i) = body->shapedirs.middleRows<3>(3 * v);
    for (SparseRows::InnerIterator it(body->weights, v); it; ++it) {
      weights.emplace_back(i, static_cast<int>(it.col()), it.value());
    }
    if (posedirs.begin.empty()) continue;
    for (int k = body->posedirs.begin[v]; k < body->posedirs.begin[v + 1]; ++k) {
      posedirs.joint.push_back(body->posedirs.joint[k]);
      const auto block = body->posedirs.block.begin() + 27 * static_cast<std::ptrdiff_t>(k);
      posedirs.block.insert(posedirs.block.end(), block, block + 27);
    }
    posedirs.begin.push_back(static_cast<int>(posedirs.joint.size()));
  }
  for (int j = 0; j < body->J_regressor.rows(); ++j) {
    for (SparseRows::InnerIterator it(body->J_regressor, j); it; ++it) {
      if (it.value() != 0) regressor.emplace_back(j, number[it.col()], it.value());
    }
  }
  body->v_template = std::move(v_template);
  body->shapedirs = std::move(shapedirs);
  body->posedirs = std::move(posedirs);
  body->weights = SparseRows(count, body->weights.cols());
  body->weights.setFromTriplets(weights.begin(), weights.end());
  body->J_regressor = SparseRows(body->J_regressor.rows(), count);
  body->J_regressor.setFromTriplets(regressor.begin(), regressor.end());  // adds up
  for (Eigen::Index i = 0; i < body->faces.size(); ++i) body->faces.data()[i] = number[body->faces.data()[i]];
  for (Landmark& landmark : body->landmarks) {
    std::map<int, double> sums;
    for (size_t i = 0; i < landmark.vertices.size(); ++i) sums[number[landmark.vertices[i]]] += landmark.weights[i];
    landmark.vertices.clear(), landmark.weights.clear();
    for (const auto& [vertex, weight] : sums) landmark.vertices.push_back(vertex), landmark.weights.push_back(weight);
  }
}

template <typename Matrix>
void KeepRows(const std::vector<int>& kept, Matrix* matrix) {
  if (matrix->rows() == 0) return;
  Matrix rows(static_cast<Eigen::Index>(kept.size()), matrix->cols());
  for (size_t i = 0; i < kept.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = matrix->row(kept[i]);
  *matrix = std::move(rows);
}

void DropFaces(const std::vector<int>& faces, BodyModelData* body) {
  std::vector<int> kept;
  for (int f = 0; f < body->faces.rows(); ++f) {
    if (!std::binary_search(faces.begin(), faces.end(), f)) kept.push_back(f);
  }
  KeepRows(kept, &body->faces);
  KeepRows(kept, &body->ft);
  KeepRows(kept, &body->face_iuv);
  if (body->face_part.empty()) return;
  std::vector<uint8_t> parts;
  parts.reserve(kept.size());
  for (const int f : kept) parts.push_back(body->face_part[f]);
  body->face_part = std::move(parts);
}

void TurnFace(int f, BodyModelData* body) {
  std::swap(body->faces(f, 1), body->faces(f, 2));
  if (body->ft.rows() > 0) std::swap(body->ft(f, 1), body->ft(f, 2));
  for (int c = 0; c < 2 && body->face_iuv.rows() > 0; ++c)
    std::swap(body->face_iuv(f, 2 + c), body->face_iuv(f, 4 + c));
}

std::set<int> VerticesThatJointsNeed(const BodyModelData& body) {
  std::set<int> needed;
  for (int j = 0; j < body.J_regressor.rows(); ++j) {
    for (SparseRows::InnerIterator it(body.J_regressor, j); it; ++it) {
      if (it.value() != 0) needed.insert(static_cast<int>(it.col()));
    }
  }
  for (const Landmark& landmark : body.landmarks) needed.insert(landmark.vertices.begin(), landmark.vertices.end());
  return needed;
}

/// New consecutive numbers of the vertices for which `stays` is true.
std::vector<int> CloseGaps(const std::vector<bool>& stays, int* count) {
  std::vector<int> number(stays.size(), -1);
  *count = 0;
  for (size_t v = 0; v < stays.size(); ++v) {
    if (stays[v]) number[v] = (*count)++;
  }
  return number;
}

void DropUnreferencedVertices(const std::vector<int>& unreferenced, BodyModelData* body, RepairBodySummary* summary) {
  const std::set<int> needed = VerticesThatJointsNeed(*body);
  std::vector<bool> stays(body->v_template.rows(), true);
  for (const int v : unreferenced) {
    stays[v] = needed.count(v) > 0;
    ++(stays[v] ? summary->vertices_in_use : summary->dropped_vertices);
  }
  int count = 0;
  const std::vector<int> number = CloseGaps(stays, &count);
  if (count < static_cast<int>(stays.size())) RenumberVertices(number, count, body);
}

void MergeVertices(const std::vector<std::array<int, 2>>& duplicates, double tolerance, BodyModelData* body,
                   RepairBodySummary* summary) {
  std::vector<bool> stays(body->v_template.rows(), true);
  for (const auto& [vertex, first] : duplicates) {
    stays[vertex] = !MoveAsOne(*body, vertex, first, tolerance);
    ++(stays[vertex] ? summary->vertices_that_part : summary->merged_vertices);
    if (stays[vertex]) continue;
    const double distance = (body->v_template.row(vertex) - body->v_template.row(first)).norm();
    summary->largest_merge_m = std::max(summary->largest_merge_m, distance);
  }
  int count = 0;
  std::vector<int> number = CloseGaps(stays, &count);
  for (const auto& [vertex, first] : duplicates) {
    if (!stays[vertex]) number[vertex] = number[first];
  }
  if (count < static_cast<int>(stays.size())) RenumberVertices(number, count, body);
}

}  // namespace

RepairBodySummary RepairBody(const RepairBodyOptions& options, BodyModelData* body) {
  *body = BodyModel(std::move(*body)).data();
  RepairBodySummary summary;
  CheckMeshOptions check;
  check.same_place_m = options.same_place_m;
  const auto found = [&] { return CheckMesh(body->v_template, body->faces, check); };
  const bool numbered_elsewhere = !StandardLandmarks(*body).empty();
  for (int round = 0; round < 2; ++round) {  // merging makes faces superfluous, whose vertices may then be unreferenced
    const std::vector<int> superfluous = SuperfluousFaces(found());
    summary.dropped_faces += static_cast<int>(superfluous.size());
    DropFaces(superfluous, body);
    if (numbered_elsewhere) continue;
    summary.vertices_in_use = summary.vertices_that_part = 0;
    DropUnreferencedVertices(found().unreferenced_vertices, body, &summary);
    MergeVertices(found().duplicate_vertices, std::max(kMinTolerance, options.same_place_m), body, &summary);
  }
  if (numbered_elsewhere) {
    const CheckMeshResult left = found();
    summary.vertices_numbered_elsewhere =
        static_cast<int>(left.duplicate_vertices.size() + left.unreferenced_vertices.size());
  }
  const std::vector<int> turned = found().turned_faces;
  summary.turned_faces = static_cast<int>(turned.size());
  for (const int f : turned) TurnFace(f, body);
  const CheckMeshResult before = found();
  if (!options.hole_faces || before.boundary_edges == 0) return summary;
  const MatrixX3i added = options.hole_faces(body->v_template, body->faces, options.max_hole_edges);
  AppendFaces(added, body);
  const CheckMeshResult after = found();
  summary.added_faces = static_cast<int>(added.rows());
  summary.filled_holes = static_cast<int>(before.boundary_loops.size() - after.boundary_loops.size());
  return summary;
}

}  // namespace bodyloom
