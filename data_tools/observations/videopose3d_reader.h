// SPDX-License-Identifier: Apache-2.0
/// Reads VideoPose3D's 2D landmarks (data_2d_h36m_*.npz, data_2d_custom_*.npz):
///   positions_2d  pickled table: subject (or video) → action ("custom") → list of cameras, each frames × 17 × 2 pixels
///   metadata      pickled table: layout_name "h36m" or "coco", num_joints, keypoints_symmetry, and of custom sets
///                 video_metadata: video → {"w", "h"}
/// NaN is a missing landmark; there are no confidences, so others have 1.
///
/// The order of the landmarks is that of the layout, else of keypoints_symmetry (left and right landmarks), else the
/// caller's. There are no times; Human3.6M's videos have 50 frames a second.
/// Source: facebookresearch/VideoPose3D, data/data_utils.py, data/prepare_data_2d_custom.py.
#pragma once

#include <string>

#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

bool IsVideoPose3d(const NpzArrays& arrays);

/// Reads the archive in `bytes`. `view` chooses "subject/action/camera" ("S1/Walking 1/0"), or a part of it that only
/// one view has; of a single view it is not used. `convention` is "" (the file's), "coco17" or "human36m17". Throws
/// std::runtime_error naming `where`, what was found, and for a missing view the views present.
KeypointSequence VideoPose3dFromNpz(const std::string& bytes, const std::string& where, const std::string& view,
                                    double fps, const std::string& convention);

/// The same for the two tables.
KeypointSequence VideoPose3dFromObjects(const PickleValue& positions, const PickleValue& metadata,
                                        const std::string& where, const std::string& view, double fps,
                                        const std::string& convention);

}  // namespace bodyloom
