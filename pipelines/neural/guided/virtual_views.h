// SPDX-License-Identifier: Apache-2.0
/// The six virtual views of a body in T-pose on which the pose-guided renderer completes its maps.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// A track of six frames: the body of shape `betas` in T-pose, its root turned so that a camera six metres away sees
/// its front, back, left, right, top and bottom (neural/guided/complete_maps.h, VirtualView).
Track VirtualViewTrack(const BodyModel& body, const Eigen::VectorXd& betas);

/// Frames of VirtualViewTrack(), in windows of size × size pixels with maps of texture_size × texture_size texels.
std::vector<PhotoFrame> VirtualViews(const BodyModel& body, const Eigen::VectorXd& betas, int size, int texture_size);

}  // namespace bodyloom
