// SPDX-License-Identifier: Apache-2.0
/// Body parts visible in an image.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// DensePose's parts 1 to 24, one per pixel of the camera's image; 0 off the body. `vertices_in_camera`: V×3, metres.
std::vector<uint8_t> PartsInImage(const BodyModel& body, const MatrixX3d& vertices_in_camera, const Camera& camera,
                                  int num_threads);

}  // namespace bodyloom
