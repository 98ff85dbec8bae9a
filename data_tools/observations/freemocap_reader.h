// SPDX-License-Identifier: Apache-2.0
/// Reads FreeMoCap's 2D landmarks:
/// output_data/raw_data/<detector>_2dData_numCams_numFrames_numTrackedPoints_pixelXY.npy, an array cameras × frames ×
/// points × 2 of pixels, NaN where nothing was detected; or one camera of it, frames × points × 2.
///
/// 133 points are RTMPose's (COCO-WholeBody); any other number from 33 on begins with MediaPipe's 33 of the body (its
/// holistic tracker has 543 or 553, hands and face behind them). There are no confidences: detected points get 1. Some
/// versions have a third number per point, a confidence or a depth: it is ignored. FreeMoCap's 3D
/// (frames × points × 3, millimetres, triangulated from all cameras in its own world) is not a detection and refused.
/// Source: freemocap/freemocap, data_layer/recording_models; skellytracker; the file's name states its shape.
#pragma once

#include <cstdint>
#include <string>

#include "data_tools/formats/ndarray.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// Index of the camera `view` ("0", "1", …; "" when there is one) of an array's. Throws std::runtime_error naming
/// `where` and the cameras.
int64_t FindArrayCamera(const std::string& view, int64_t num_cameras, const std::string& where);

/// Returns true for an array of 33 points or more with 2 or 3 numbers each, but for frames × points × 3 of COCO's or
/// Halpe's family, which may have confidences (keypoint_array_reader.h).
bool IsFreeMocap(const NdArray& array);

/// `view` chooses the camera: "0", "1", … in the array's order, which is that of the videos' names; "" when there is
/// one.
/// Throws std::runtime_error naming `where`, what was found and what was expected.
KeypointSequence FreeMocapFromArray(const NdArray& array, const std::string& where, const std::string& view,
                                    double fps);

}  // namespace bodyloom
