// SPDX-License-Identifier: Apache-2.0
/// Visible texels of the body's maps in a frame, and maps of these alone.
#pragma once

#include <span>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/camera.h"
#include "bodyloom/geometry/uv_texels.h"
#include "bodyloom/render/visibility_buffer.h"

namespace bodyloom::describe_internal {

struct SeenTexels {
  std::vector<char> seen;  ///< W·H, not 0 where it is seen; a gutter texel goes with the texels of its chart beside it
  double share = 0;        ///< of the texels inside the charts
};

/// `buffer` is room for the picture.
SeenTexels FindSeenTexels(const UvTexelTable& table, const BodyModel& body, const MatrixX3d& vertices_in_camera,
                          const Camera& camera, VisibilityBuffer* buffer);

/// The maps (each of three planes of items of `item_size` bytes) one after another, zero at texels that are not seen.
std::vector<char> KeepSeen(const UvTexelTable& table, const std::vector<char>& seen,
                           std::span<const std::span<const char>> maps, size_t item_size);

}  // namespace bodyloom::describe_internal
