// SPDX-License-Identifier: Apache-2.0
/// Observations made in a video's pixels, moved into those of the camera that its calibration describes.
#pragma once

#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/geometry/observations.h"

namespace bodyloom {

/// Keypoints at p become those at q with p = video_from_camera · (q, 1). The image size becomes the camera's.
KeypointSequence MovedToCamera(KeypointSequence keypoints, const Matrix2x3d& video_from_camera, int camera_width,
                               int camera_height);

/// Labels: each pixel of the camera's image takes the label of the video's pixel next to its place.
PartLabelSequence MovedToCamera(const PartLabelSequence& labels, const Matrix2x3d& video_from_camera, int camera_width,
                                int camera_height);

}  // namespace bodyloom
