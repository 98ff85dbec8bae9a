// SPDX-License-Identifier: Apache-2.0
/// Visibility of the texels of a UV map in a camera and their pixels: texel → surface point → pixel, tested against the
/// visibility buffer. The inverse direction, from pixels to texels, is render/texture/uv_sample.h.
///
/// A texel is seen when its surface point projects into the image, its face is turned to the camera by at least
/// min_cosine, and the pixels around the projection show the same surface: their depth, relative to the face's plane,
/// is within the tolerance bias_m + slope · (size of a pixel at that depth) · tan(angle). A fixed tolerance would
/// misclassify steep or occluded faces.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

struct TexelVisibilityOptions {
  double min_cosine = 0.1;  ///< of the angle between the face's normal and the ray; 0 to 1
  double bias_m = 0.003;
  double slope = 1.5;
  /// True: all four pixels of a bilinear lookup must show the surface, so that no colour of other surfaces leaks in;
  /// false: only the nearest pixel.
  bool whole_footprint = false;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct TexelVisibility {
  float x_px = 0, y_px = 0;    ///< pixel of its surface point
  float cosine = 0;            ///< 0: not seen
  float texels_per_pixel = 0;  ///< area of a pixel on the surface / area of a texel, from the face's three corners
};

/// One entry per texel of the table; gutter texels are never seen. `vertices_in_camera`, `faces` and `camera` must be
/// those of the buffer. Throws std::invalid_argument when options are not valid.
std::vector<TexelVisibility> ComputeTexelVisibility(const UvTexelTable& table, const BodyModel& body,
                                                    const MatrixX3d& vertices_in_camera, const Camera& camera,
                                                    const VisibilityBuffer& buffer,
                                                    const TexelVisibilityOptions& options = {});

}  // namespace bodyloom
