// SPDX-License-Identifier: Apache-2.0
/// The light on a body's surface in a picture: taken away from a photo, given to a drawn body.
///   lit = Encode( Decode(even) · s ),   even = Encode( Decode(lit) / s ),   s = clamp(shading(n), least, most)
/// colour by colour, n the surface's normal in the camera frame (render/lighting/sh_lighting.h), picture and light
/// related as in IEC 61966-2-1. Light of strength 1 from everywhere changes nothing. Exact for Lambertian surfaces
/// without cast shadows. The two are inverses of each other but for rounding to a byte and colours brighter than white.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/lighting/sh_lighting.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

/// Where s is cut off: what is darker shows the noise of dark pixels when light is taken away.
struct ShadingLimits {
  double least = 0.05, most = 4;
};

/// Keeps its memory between pictures. Not for use by two threads at once.
class LitSurface {
 public:
  /// `body` must outlive this. `both_sides`: faces that turn away are seen too, their normals turned to the viewer.
  LitSurface(const BodyModel& body, bool both_sides, int num_threads);

  /// What the camera sees: the normals of the pixels whose centres the body covers. `vertices_in_camera`: V×3, metres.
  /// The same for any number of threads.
  void Look(const MatrixX3d& vertices_in_camera, const Camera& camera);

  /// Three numbers, unit length, camera frame; null where the body does not cover the pixel's centre.
  [[nodiscard]] const float* NormalAt(int x, int y) const;

  /// Lights the body, drawn over black in even light, of which `coverage`, one a pixel, says 0 to 255 how much of the
  /// pixel it is. At the outline, where the body misses the pixel's centre, the shading is that of its neighbours.
  /// Throws std::invalid_argument when image, coverage and the camera of Look() differ in size, or for limits that are
  /// not 0 < least <= most.
  void Light(const ShLighting& light, const ShadingLimits& limits, std::span<const uint8_t> coverage,
             Image* image) const;
  /// Takes the light away from a picture in which the body covers whole pixels; other pixels stay. Throws as Light().
  void Unlight(const ShLighting& light, const ShadingLimits& limits, Image* image) const;

 private:
  void CheckSizes(const ShadingLimits& limits, const Image& image) const;

  const BodyModel* body_;
  bool both_sides_;
  int threads_;
  int width_ = 0, height_ = 0;
  VisibilityBuffer buffer_;
  ResolvedPixels pixels_;
  VertexNormalsOfMesh normals_;
};

}  // namespace bodyloom
