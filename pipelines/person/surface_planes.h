// SPDX-License-Identifier: Apache-2.0
/// Draws what a body's surface is like into person layers (render/person/person_layers.h): its normal, and where its
/// points lie at rest.
#pragma once

#include <vector>

#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/vertex_normals.h"
#include "bodyloom/render/person/person_layers.h"
#include "bodyloom/render/resolve_pixels.h"
#include "bodyloom/render/visibility_buffer.h"

namespace bodyloom {

/// Keeps its memory between pictures. Not for use by two threads at once.
class SurfacePlanes {
 public:
  /// `body` must outlive this; `rest_vertices`: V×3, metres.
  SurfacePlanes(const BodyModel& body, const MatrixX3d& rest_vertices, int num_threads);

  /// kNormal and kPlace where alpha is above 0 and the surface is seen from outside, 0 elsewhere; other planes stay.
  /// The same for any number of threads.
  void Draw(const MatrixX3d& vertices_in_camera, const Camera& camera, PersonLayers* layers);

 private:
  const BodyModel* body_;
  int threads_;
  std::vector<float> places_;  ///< 3 a vertex
  VisibilityBuffer buffer_;
  ResolvedPixels pixels_;
  VertexNormalsOfMesh normals_;
};

}  // namespace bodyloom
