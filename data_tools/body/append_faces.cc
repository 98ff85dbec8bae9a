// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/append_faces.h"

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "geometry/base/check.h"

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

}  // namespace

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

}  // namespace bodyloom
