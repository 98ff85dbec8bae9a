// SPDX-License-Identifier: Apache-2.0
/// Visibility of the texels of a UV map in a camera, and where they are seen: texel → surface point → pixel, tested
/// against the visibility buffer. The way from the map to the image; the other way is render/texture/uv_sample.h.
///
/// A texel is seen when its surface point projects into the image, its face looks at the camera by at least min_cosine,
/// and the pixels around the projection show the same piece of surface: their depth, carried along the face's plane, is
/// within the tolerance  bias_m + slope · (size of a pixel at that depth) · tan(angle).  A fixed tolerance would call
/// steep faces hidden or hidden faces seen.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

struct TexelSightOptions {
  double min_cosine = 0.1;  ///< of the angle between the face's normal and the ray; 0 to 1
  double bias_m = 0.003;
  double slope = 1.5;
  /// True: all four pixels of a bilinear lookup must show the surface, so that no colour of what lies behind or before
  /// leaks in; false: the nearest pixel.
  bool whole_footprint = false;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Of one texel.
struct TexelSight {
  float x_px = 0, y_px = 0;    ///< where its point is in the image
  float cosine = 0;            ///< 0: not seen
  float texels_per_pixel = 0;  ///< area of a pixel on the surface / area of a texel, from the face's three corners
};

/// One entry a texel of the table; gutter texels are never seen. `vertices_in_camera`, `faces` and `camera` must be
/// those of the buffer. Faces that look away are passed over whole. Throws std::invalid_argument when options are not
/// valid.
std::vector<TexelSight> SeeTexels(const UvTexelTable& table, const BodyModel& body, const MatrixX3d& vertices_in_camera,
                                  const Camera& camera, const VisibilityBuffer& buffer,
                                  const TexelSightOptions& options = {});

}  // namespace bodyloom
