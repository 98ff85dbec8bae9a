// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/body/normals_simd.h"

namespace bodyloom {

using Eigen::Vector3f;

namespace {

constexpr int kMaxRings = 8;
/// A mean of unit vectors shorter than this points nowhere in particular.
constexpr float kNoDirection = 1e-3F;

/// The power of two that brings coordinates up to `largest` to about 1, so that products of them neither overflow nor
/// vanish; exact.
float UnitFactor(float largest) {
  if (largest == 0) return 1;
  return std::ldexp(1.0F, -std::clamp(std::ilogb(largest), -120, 120));
}

Vector3f TurnedTemplateNormal(const NormalFallback& fallback, int v) {
  const BodyModel& body = *fallback.body;
  const Eigen::Vector3d n = fallback.template_normals->row(v).transpose().cast<double>();
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (int k = body.influence_begin()[v]; k < body.influence_begin()[v + 1]; ++k) {
    turned += body.influence_weight()[k] * (fallback.skeleton->world_rotations[body.influence_joint()[k]] * n);
  }
  return turned.norm() > kNoDirection ? Vector3f(turned.normalized().cast<float>()) : Vector3f(Vector3f::Zero());
}

}  // namespace

NormalSummary& NormalSummary::operator+=(const NormalSummary& other) {
  meshes += other.meshes;
  degenerate_faces += other.degenerate_faces;
  from_neighbours += other.from_neighbours;
  from_template += other.from_template;
  undefined += other.undefined;
  return *this;
}

MeshNormals::MeshNormals(const MatrixX3i& faces, int num_vertices, NormalWeighting weighting)
    : adjacency_(BuildMeshAdjacency(faces, num_vertices)),
      faces_(faces),
      weighting_(weighting),
      items_(adjacency_.corner) {
  if (weighting == NormalWeighting::kArea) {
    for (int& item : items_) item /= 3;
  }
}

NormalSummary MeshNormals::Compute(std::span<const float> vertices, std::span<float> normals, NormalScratch* scratch,
                                   const NormalFallback& fallback) const {
  const int V = num_vertices(), F = static_cast<int>(faces_.rows());
  const size_t size = 3 * static_cast<size_t>(V);
  BODYLOOM_CHECK(vertices.size() == size && normals.size() == size, "normals: ", vertices.size(), " values in, ",
                 normals.size(), " out, expected ", size, " (3 a vertex)");
  const float largest = normals_internal::LargestMagnitude(vertices.data(), static_cast<int64_t>(size));
  BODYLOOM_CHECK(std::isfinite(largest), "normals: a vertex holds NaN or infinite values");

  const size_t padded_faces = (static_cast<size_t>(F) + 3) / 4 * 4;
  scratch->positions.resize(4 * static_cast<size_t>(V));
  scratch->face_vectors.resize((weighting_ == NormalWeighting::kArea ? 4 : 12) * padded_faces);
  scratch->missing.resize(V);
  normals_internal::PadVertices(vertices.data(), V, UnitFactor(largest), scratch->positions.data());
  const auto vectors_of =
      weighting_ == NormalWeighting::kArea ? normals_internal::FaceVectors : normals_internal::CornerVectors;
  const int64_t degenerate = vectors_of(scratch->positions.data(), faces_.data(), F, scratch->face_vectors.data());
  const int num_missing = normals_internal::VertexSums(scratch->face_vectors.data(), adjacency_.corner_begin.data(),
                                                       items_.data(), V, normals.data(), scratch->missing.data());
  NormalSummary summary;
  if (num_missing > 0) summary = FillMissing(normals, scratch, fallback);
  summary.meshes = 1;
  summary.degenerate_faces = degenerate;
  return summary;
}

NormalSummary MeshNormals::FillMissing(std::span<float> normals, NormalScratch* scratch,
                                       const NormalFallback& fallback) const {
  NormalSummary summary;
  const auto normal = [&normals](int v) { return Eigen::Map<Vector3f>(normals.data() + 3 * static_cast<size_t>(v)); };
  std::vector<int> missing;
  for (int v = 0; v < num_vertices(); ++v) {
    if (scratch->missing[v]) missing.push_back(v);
  }
  for (int ring = 0; ring < kMaxRings && !missing.empty(); ++ring) {
    // A vertex found in this round does not help another one before the next, so the order does not matter.
    std::vector<int> found, rest;
    for (int v : missing) {
      Vector3f sum = Vector3f::Zero();
      int count = 0;
      for (int k = adjacency_.corner_begin[v]; k < adjacency_.corner_begin[v + 1]; ++k) {
        const int face = adjacency_.corner[k] / 3;
        for (int c = 0; c < 3; ++c) {
          const int neighbour = faces_(face, c);
          if (scratch->missing[neighbour]) continue;
          sum += normal(neighbour);
          ++count;
        }
      }
      const bool usable = sum.norm() > kNoDirection * static_cast<float>(count);
      if (usable) normal(v) = sum.normalized();
      (usable ? found : rest).push_back(v);
    }
    if (found.empty()) break;
    for (int v : found) scratch->missing[v] = 0;
    summary.from_neighbours += static_cast<int64_t>(found.size());
    missing.swap(rest);
  }
  for (int v : missing) {
    Vector3f turned = Vector3f::Zero();
    if (fallback.body != nullptr) turned = TurnedTemplateNormal(fallback, v);
    normal(v) = turned;
    ++(turned.isZero(0) ? summary.undefined : summary.from_template);
  }
  return summary;
}

NormalSummary MeshNormals::ComputeFrames(std::span<const float> vertices, std::span<float> normals,
                                         int num_threads) const {
  const size_t size = 3 * static_cast<size_t>(num_vertices());
  BODYLOOM_CHECK(size > 0 && vertices.size() % size == 0 && normals.size() == vertices.size(),
                 "normals: ", vertices.size(), " values in, ", normals.size(), " out, expected frames x ", size);
  const int T = static_cast<int>(vertices.size() / size);
  // A few frames a task share their scratch memory.
  const int num_tasks = std::min(T, 4 * std::max(1, num_threads));
  std::vector<NormalSummary> of_task(num_tasks);
  ParallelFor(num_tasks, num_threads, [&](int task) {
    NormalScratch scratch;
    const int first = static_cast<int>(int64_t{T} * task / num_tasks);
    const int last = static_cast<int>(int64_t{T} * (task + 1) / num_tasks);
    for (int t = first; t < last; ++t) {
      of_task[task] += Compute(vertices.subspan(size * t, size), normals.subspan(size * t, size), &scratch);
    }
  });
  NormalSummary summary;
  for (const NormalSummary& part : of_task) summary += part;
  return summary;
}

MatrixX3f TemplateNormals(const BodyModel& body, NormalWeighting weighting) {
  const Eigen::RowVector3d root = body.joint_template().row(0);
  const MatrixX3f vertices = (body.data().v_template.rowwise() - root).cast<float>();
  MatrixX3f normals(vertices.rows(), 3);
  NormalScratch scratch;
  MeshNormals(body.data().faces, body.num_vertices(), weighting)
      .Compute({vertices.data(), static_cast<size_t>(vertices.size())},
               {normals.data(), static_cast<size_t>(normals.size())}, &scratch);
  return normals;
}

const MatrixX3f& VertexNormalsOfMesh::Compute(const MatrixX3d& vertices, const MatrixX3i& faces) {
  BODYLOOM_CHECK(vertices.rows() > 0, "vertex normals: the mesh has no vertices");
  const auto is_same = [&](const MatrixX3i& known) { return known.rows() == faces.rows() && known == faces; };
  if (!mesh_ || mesh_->num_vertices() != vertices.rows() || !is_same(mesh_->faces())) {
    mesh_ = std::make_shared<const MeshNormals>(faces, static_cast<int>(vertices.rows()));
  }
  relative_ = (vertices.rowwise() - vertices.row(0)).cast<float>();
  normals_.resize(vertices.rows(), 3);
  mesh_->Compute({relative_.data(), static_cast<size_t>(relative_.size())},
                 {normals_.data(), static_cast<size_t>(normals_.size())}, &scratch_);
  return normals_;
}

MatrixX3f VertexNormals(const MatrixX3d& vertices, const MatrixX3i& faces) {
  return VertexNormalsOfMesh().Compute(vertices, faces);
}

}  // namespace bodyloom
