// SPDX-License-Identifier: Apache-2.0
/// Removes the light on a body's surface from a photo and applies light to a rendered body.
///   lit = Encode( Decode(even) · s ),   even = Encode( Decode(lit) / s ),   s = clamp(shading(n), minimum, maximum)
/// per colour channel, n the surface's normal in the camera frame (render/lighting/sh_lighting.h), pixel values encoded
/// as in IEC 61966-2-1. Uniform light of radiance 1 changes nothing. Exact for Lambertian surfaces without cast
/// shadows. The two are inverses of each other up to rounding to a byte and clipping at white.
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

/// Limits of s: removing darker light would amplify the noise of dark pixels.
struct ShadingLimits {
  double minimum = 0.05, maximum = 4;
};

/// Keeps its memory between images. Not for use by two threads at once.
class LitSurface {
 public:
  /// `body` must outlive this. `both_sides`: back faces are visible too, with normals flipped to the viewer.
  LitSurface(const BodyModel& body, bool both_sides, int num_threads);

  /// Computes the normals at the pixels whose centres the body covers. `vertices_in_camera`: V×3, metres. The same for
  /// any number of threads.
  void Look(const MatrixX3d& vertices_in_camera, const Camera& camera);

  /// Unit normal (3 floats), camera frame; null where the body does not cover the pixel's centre.
  [[nodiscard]] const float* NormalAt(int x, int y) const;

  /// Lights the body in an image rendered over black in even light. `coverage`: one per pixel, the share that the body
  /// covers, 0 to 255. At the outline, where the body misses the pixel's centre, the shading is that of its neighbours.
  /// Throws std::invalid_argument when image, coverage and the camera of Look() differ in size, or for limits that are
  /// not 0 < minimum <= maximum.
  void Light(const ShLighting& light, const ShadingLimits& limits, std::span<const uint8_t> coverage,
             Image* image) const;
  /// Removes the light from an image in which the body covers whole pixels; other pixels stay. Throws as Light().
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
