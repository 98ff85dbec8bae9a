// SPDX-License-Identifier: Apache-2.0
/// What a picture shows of a body, part by part.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"

namespace bodyloom {

/// DensePose's parts 1 to 24 of the body, one a pixel of the camera's picture; 0 off it. `vertices_in_camera`: V×3,
/// metres.
std::vector<uint8_t> PartsInPicture(const BodyModel& body, const MatrixX3d& vertices_in_camera, const Camera& camera,
                                    int num_threads);

}  // namespace bodyloom
