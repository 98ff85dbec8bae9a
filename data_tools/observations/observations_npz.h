// SPDX-License-Identifier: Apache-2.0
/// The project's own file of observations: a .npz with one person's 2D keypoints, dense surface keypoints, or both.
/// Keypoints of several people: people_npz.h.
///
/// | key                | shape  | type  | meaning                                                             |
/// |--------------------|--------|-------|---------------------------------------------------------------------|
/// | timestamps         | T      | f8    | seconds, strictly increasing                                        |
/// | image_size         | 2      | i4    | width, height in pixels; 0, 0 when not known                        |
/// | keypoints          | T×K×3  | f4    | x_px, y_px, confidence in [0,1] (0: missing)                        |
/// | keypoint_names     | K      | text  | landmark names                                                      |
/// | keypoint_convention| scalar | text  | "coco17", …                                                         |
/// | dense_frame        | N      | i4    | frame of each dense keypoint, not decreasing                        |
/// | dense_face         | N      | i4    | face of the body                                                    |
/// | dense_barycentric  | N×3    | f4    | weights of the face's corners, sum 1                                |
/// | dense_pixel        | N×2    | f4    | x_px, y_px                                                          |
/// | dense_sigma_px     | N      | f4    | standard deviation of the pixel                                     |
/// | dense_uv_sigma     | scalar | f8    | DenseSequence::uv_sigma, chart units; may be missing: 0, not known   |
/// | dense_pixel_sigma_px| scalar| f8    | DenseSequence::pixel_sigma_px, pixels; may be missing: 0, not known  |
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/npz.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// Writes those that are not null (at least one; both must have the same timestamps and image size).
void WriteObservations(const std::string& path, const KeypointSequence* keypoints, const DenseSequence* dense);

/// The key `timestamps`: T > 0 finite, increasing seconds.
std::vector<double> TimestampsFromNpz(const NpzArrays& arrays, const std::string& where);

/// The key `image_size`, if there is one.
void ImageSizeFromNpz(const NpzArrays& arrays, const std::string& where, int* width, int* height);

/// The key `keypoint_names`: a list of text.
std::vector<std::string> KeypointNamesFromNpz(const NpzArrays& arrays, const std::string& where);

/// The key `keypoint_convention`; "custom" if there is none.
std::string ConventionNameFromNpz(const NpzArrays& arrays);

bool HasKeypoints(const NpzArrays& arrays);
bool HasDense(const NpzArrays& arrays);
/// Throw std::runtime_error naming `where`, the key, what it holds and what was expected.
KeypointSequence KeypointsFromNpz(const NpzArrays& arrays, const std::string& where);
DenseSequence DenseFromNpz(const NpzArrays& arrays, const std::string& where);
DenseSequence ReadDenseObservations(const std::string& path);

}  // namespace bodyloom
