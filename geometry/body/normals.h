// SPDX-License-Identifier: Apache-2.0
/// Unit normals at the vertices of a mesh: the sum over the faces at a vertex of w · (unit face normal), normalised.
///   area:  w = area of the face          angle: w = the face's angle at the vertex
/// Faces are counter-clockwise seen from outside. Faces are given by position indices, so seams of a UV map have no
/// effect.
///
/// Vertices are floats relative to the root joint (Skinner::SkinFromRoot): at 10 m from the origin a face of 2 mm would
/// lose its normal to rounding. The result does not depend on the unit of length (tested from 1e-15 to 1e15).
///
/// Never NaN. A face counts as degenerate, and is left out, when its area is within rounding error: |e1 × e2|∞ ≤ 4 ε
/// max |e|². A vertex whose faces are all degenerate or cancel out takes, in this order:
///   1. the mean of the normals of the vertices it shares a face with (repeated outwards, eight rings at most),
///   2. its normal on the template, turned by its skinning weights, when a fallback is given,
///   3. the zero vector, counted as `undefined`: a vertex without any face, or a mesh that is one point.
/// Every vertex that takes one of these is counted.
///
/// Determinism: same bytes for any number of threads; instruction sets differ in the last bits.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/arrays.h"
#include "geometry/mesh/mesh_adjacency.h"

namespace bodyloom {

enum class NormalWeighting { kArea, kAngle };

/// Over all meshes of a call.
struct NormalSummary {
  int64_t meshes = 0;
  int64_t degenerate_faces = 0;
  int64_t from_neighbours = 0, from_template = 0, undefined = 0;  ///< vertices
  NormalSummary& operator+=(const NormalSummary& other);
};

/// Data of the second fallback: the body in its pose.
struct NormalFallback {
  const BodyModel* body = nullptr;  ///< none: this step is left out
  const MatrixX3f* template_normals = nullptr;
  const PosedSkeleton* skeleton = nullptr;
};

/// Memory that repeated calls share; one a thread.
struct NormalScratch {
  std::vector<float> positions, face_vectors;
  std::vector<uint8_t> missing;
};

class MeshNormals {
 public:
  /// Copies the faces. Throws std::invalid_argument on an index outside 0..num_vertices−1.
  MeshNormals(const MatrixX3i& faces, int num_vertices, NormalWeighting weighting = NormalWeighting::kArea);

  [[nodiscard]] int num_vertices() const { return static_cast<int>(adjacency_.corner_begin.size()) - 1; }
  [[nodiscard]] const MatrixX3i& faces() const { return faces_; }
  [[nodiscard]] const MeshAdjacency& adjacency() const { return adjacency_; }

  /// One mesh: V×3 in, V×3 out. Throws std::invalid_argument when the sizes are wrong or a vertex is not finite.
  NormalSummary Compute(std::span<const float> vertices, std::span<float> normals, NormalScratch* scratch,
                        const NormalFallback& fallback = {}) const;

  /// T meshes on up to num_threads threads: T×V×3 in and out.
  NormalSummary ComputeFrames(std::span<const float> vertices, std::span<float> normals, int num_threads) const;

 private:
  NormalSummary FillMissing(std::span<float> normals, NormalScratch* scratch, const NormalFallback& fallback) const;

  MeshAdjacency adjacency_;
  MatrixX3i faces_;
  NormalWeighting weighting_;
  std::vector<int> items_;  ///< as adjacency_.corner: which of the scratch's vectors each vertex sums
};

/// The template's normals (V×3), for NormalFallback.
MatrixX3f TemplateNormals(const BodyModel& body, NormalWeighting weighting = NormalWeighting::kArea);

// Area-weighted normals of meshes given in double, at any distance from the origin, for rendering: vertices are taken
// relative to the first one and passed to MeshNormals.

/// For successive meshes with the same faces, such as the frames of a clip: the adjacency is computed once. Not for use
/// by two threads at once.
class VertexNormalsOfMesh {
 public:
  VertexNormalsOfMesh() = default;
  /// Starts with the adjacency of `mesh`, which several instances can share.
  explicit VertexNormalsOfMesh(std::shared_ptr<const MeshNormals> mesh) : mesh_(std::move(mesh)) {}

  /// V×3 unit normals, valid until the next call. Throws std::invalid_argument as MeshNormals does.
  const MatrixX3f& Compute(const MatrixX3d& vertices, const MatrixX3i& faces);

 private:
  std::shared_ptr<const MeshNormals> mesh_;
  NormalScratch scratch_;
  MatrixX3f relative_, normals_;
};

/// The same for a single mesh.
MatrixX3f VertexNormals(const MatrixX3d& vertices, const MatrixX3i& faces);

}  // namespace bodyloom
