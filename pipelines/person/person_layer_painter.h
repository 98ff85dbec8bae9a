// SPDX-License-Identifier: Apache-2.0
/// Draws a person made from photos plane by plane (render/person/person_layers.h).
#pragma once

#include <vector>

#include "bodyloom/geometry/camera.h"
#include "bodyloom/pipelines/person/draw_person.h"
#include "bodyloom/pipelines/person/surface_planes.h"
#include "bodyloom/render/person/person_layers.h"

namespace bodyloom {

/// Keeps its memory between pictures. Not for use by two threads at once.
class PersonLayerPainter {
 public:
  /// `person` must outlive this. Layers are the same for any number of threads.
  PersonLayerPainter(const PhotoPerson& person, int num_threads);

  /// The layers of the part of the camera's picture that shows the person, with `kReach` pixels around it.
  PersonLayers Draw(const MatrixX3d& vertices_in_camera, const Camera& camera);
  /// Colour and alpha alone, the first four planes, with `reach` pixels around the person.
  PersonLayers DrawColours(const MatrixX3d& vertices_in_camera, const Camera& camera, int reach);

  static constexpr int kReach = 16;  ///< at least; clothes and hair that the body lacks

 private:
  const PhotoPerson* person_;
  PersonPainter painter_;
  std::vector<float> sources_;  ///< 2 a texel: seen, mirrored
  SurfacePlanes surface_;
};

}  // namespace bodyloom
