// SPDX-License-Identifier: Apache-2.0
#include "render/garment/clothes_offsets.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/normals.h"
#include "render/raster/visibility_buffer.h"
#include "render/texture/body_regions.h"

namespace bodyloom {
namespace {

constexpr double kStepPx = 0.5;
constexpr double kOntoContourPx = 3;  ///< a contour vertex' normal leaves the body within so many pixels
constexpr double kProbeM = 0.001;

/// Searches body and mask of one image along vertex normals.
class RimWalk {
 public:
  RimWalk(const Camera& camera, const LabelImage& mask, const VisibilityBuffer& buffer,
          const ClothesOffsetOptions& options)
      : camera_(camera), mask_(mask), buffer_(buffer), options_(options) {}

  /// Distance from the edge of the body to that of the person along the vertex' normal, metres.
  [[nodiscard]] std::optional<double> Measure(const Eigen::Vector3d& vertex, const Eigen::Vector3d& normal) const {
    const bool orthographic = camera_.model == CameraModel::kWeakPerspective;
    const Eigen::Vector3d sight = orthographic ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : vertex.normalized();
    if (std::abs(normal.dot(sight)) > options_.rim_cosine) return std::nullopt;
    Eigen::Vector2d at, beside;
    if (!camera_.Project(vertex, &at) || !camera_.Project(vertex + kProbeM * normal, &beside)) return std::nullopt;
    const double px_per_m = (beside - at).norm() / kProbeM;
    if (!(px_per_m > 0)) return std::nullopt;
    const Eigen::Vector2d out = (beside - at).normalized();

    double left = 0;  // edge of the body
    while (IsBody(at + left * out)) {
      left += kStepPx;
      if (left > kOntoContourPx) return std::nullopt;
    }
    const Eigen::Vector2d outside = at + left * out;
    if (!IsInImage(outside)) return std::nullopt;
    if (IsPerson(outside)) {
      for (double along = left; along - left <= options_.furthest_m * px_per_m; along += kStepPx) {
        const Eigen::Vector2d p = at + along * out;
        if (!IsInImage(p) || (along > left + kOntoContourPx && IsBody(p))) return std::nullopt;
        if (!IsPerson(p)) return (along - left) / px_per_m;
      }
      return std::nullopt;
    }
    for (double along = left; left - along <= options_.deepest_m * px_per_m; along -= kStepPx) {
      if (IsPerson(at + along * out)) return (along - left) / px_per_m;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool IsInImage(const Eigen::Vector2d& p) const {
    return p.x() >= 0 && p.y() >= 0 && p.x() <= camera_.width - 1 && p.y() <= camera_.height - 1;
  }
  [[nodiscard]] bool IsBody(const Eigen::Vector2d& p) const {
    return buffer_.FaceAt(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) >= 0;
  }
  [[nodiscard]] bool IsPerson(const Eigen::Vector2d& p) const {
    return mask_.At(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))) != 0;
  }

  const Camera& camera_;
  const LabelImage& mask_;
  const VisibilityBuffer& buffer_;
  const ClothesOffsetOptions& options_;
};

}  // namespace

ClothesOffsets FitClothesOffsets(const BodyModel& body, const MatrixX3d& rest_vertices,
                                 const MatrixX3d& vertices_in_camera, const Camera& camera, const LabelImage& mask,
                                 const ClothesOffsetOptions& options, std::span<const uint8_t> covered) {
  const int count = body.num_vertices();
  BODYLOOM_CHECK(rest_vertices.rows() == count && vertices_in_camera.rows() == count, rest_vertices.rows(), " and ",
                 vertices_in_camera.rows(), " vertices, expected ", count);
  BODYLOOM_CHECK(covered.empty() || static_cast<int>(covered.size()) == count, covered.size(),
                 " vertices covered or not, expected ", count);
  const MatrixX3i& faces = body.data().faces;
  VisibilityBuffer buffer;
  buffer.Render(vertices_in_camera, faces, camera);
  const MatrixX3f normals = VertexNormals(vertices_in_camera, faces);
  const std::vector<BodyRegion> regions = BodyRegions(body, rest_vertices);
  const RimWalk walk(camera, mask, buffer, options);

  ClothesOffsets offsets;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count), diagonal(count);
  for (int v = 0; v < count; ++v) {
    const bool anchored =
        regions[v] == BodyRegion::kFace || regions[v] == BodyRegion::kHand || (!covered.empty() && covered[v] != 0);
    diagonal[v] = anchored ? options.anchor : options.decay;
    if (anchored) continue;
    const std::optional<double> measured =
        walk.Measure(vertices_in_camera.row(v).transpose(), normals.row(v).transpose().cast<double>());
    if (!measured) continue;
    ++offsets.measured;
    diagonal[v] += 1;
    right[v] += *measured;
  }
  std::set<std::pair<int, int>> edges;
  for (int f = 0; f < faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({faces(f, k), faces(f, (k + 1) % 3)});
      if (low != high) edges.emplace(low, high);
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [a, b] : edges) {
    entries.emplace_back(a, b, -options.smoothness);
    entries.emplace_back(b, a, -options.smoothness);
    diagonal[a] += options.smoothness, diagonal[b] += options.smoothness;
  }
  for (int v = 0; v < count; ++v) entries.emplace_back(v, v, diagonal[v]);
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd solution = solver.solve(right);
  offsets.metres.resize(count);
  for (int v = 0; v < count; ++v) offsets.metres[v] = std::clamp(solution[v], -options.deepest_m, options.furthest_m);
  return offsets;
}

}  // namespace bodyloom
