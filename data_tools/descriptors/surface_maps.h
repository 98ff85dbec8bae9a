// SPDX-License-Identifier: Apache-2.0
/// Surface maps of one posed body: its unit normals, or its velocities, as three planes over the atlas.
#pragma once

#include <span>

#include "bodyloom/data_tools/descriptors/map_memory.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/normals.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/geometry/uv_bake.h"
#include "bodyloom/geometry/uv_texels.h"

namespace bodyloom::describe_internal {

/// Immutable and safe to share between threads. Texels that show nothing are left as they are.
class SurfaceMaps {
 public:
  /// Borrows the body. Throws std::invalid_argument when it has no UV map. `normals`: whether any will be requested.
  SurfaceMaps(const BodyModel& body, const UvTexelOptions& texels, NormalWeighting weighting, bool normals);

  [[nodiscard]] const UvTexelTable& texels() const { return table_; }
  [[nodiscard]] size_t num_pixels() const { return static_cast<size_t>(baker_.num_pixels()); }

  /// Unit normals of vertices (V×3, from the root). Returns the texels whose corners' normals cancelled out.
  int Normals(std::span<const float> vertices, const PosedSkeleton& skeleton, Scratch* scratch, NormalSummary* summary,
              std::span<float> planes) const;

  /// The vertices' velocities (V×3).
  void Velocities(std::span<const float> velocities, Scratch* scratch, std::span<float> planes) const;

 private:
  const BodyModel& body_;
  UvTexelTable table_;
  UvBaker baker_;
  MeshNormals normals_;
  MatrixX3f template_normals_;
};

}  // namespace bodyloom::describe_internal
