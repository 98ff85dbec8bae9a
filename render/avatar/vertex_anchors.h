// SPDX-License-Identifier: Apache-2.0
/// Vertices of a body as places that Gaussians are anchored at.
#pragma once

#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/render/avatar/gaussian_body.h"

namespace bodyloom {

/// Keeps a reference to the body.
class VertexAnchors {
 public:
  explicit VertexAnchors(const BodyModel& model);
  /// On the first face that has the vertex.
  [[nodiscard]] SkinAnchor At(int vertex, float corrective_factor) const;

 private:
  const BodyModel& model_;
  std::vector<int> face_of_;
};

}  // namespace bodyloom
