// SPDX-License-Identifier: Apache-2.0
/// Moves observations between the pixels of a video and those of the camera that the tracker uses.
#pragma once

#include <string>

#include "data_tools/observations/load_cameras.h"
#include "data_tools/video/video_reader.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

/// Moves keypoints at p to map · (p, 1). The image size becomes width × height.
KeypointSequence MovedKeypoints(KeypointSequence keypoints, const Matrix2x3d& map, int width, int height);

/// The same; standard deviations and depths are scaled by the square root of the map's determinant.
HandsAndFaceSequence MovedKeypoints(HandsAndFaceSequence hands_and_face, const Matrix2x3d& map, int width, int height);

/// Moves keypoints at p to q with p = video_from_camera · (q, 1). The image size becomes the camera's.
KeypointSequence MovedToCamera(KeypointSequence keypoints, const Matrix2x3d& video_from_camera, int camera_width,
                               int camera_height);
HandsAndFaceSequence MovedToCamera(HandsAndFaceSequence hands_and_face, const Matrix2x3d& video_from_camera,
                                   int camera_width, int camera_height);

/// The same; standard deviations in pixels are scaled by the square root of the map's determinant.
DenseSequence MovedToCamera(DenseSequence dense, const Matrix2x3d& video_from_camera, int camera_width,
                            int camera_height);

/// Resamples labels: each pixel of the camera's image takes the label of the nearest pixel of the video.
PartLabelSequence MovedToCamera(const PartLabelSequence& labels, const Matrix2x3d& video_from_camera, int camera_width,
                                int camera_height);

/// The image sizes that observations of a video may have.
struct VideoPixels {
  Eigen::Vector2i square, stored;  ///< width and height as displayed and as stored (VideoInfo); zero without a video

  /// Returns true if observations of images of `seen` pixels are moved to a camera of `camera` pixels: one has the
  /// square ones of an anamorphic video, the other the stored ones.
  [[nodiscard]] bool Differ(const Eigen::Vector2i& seen, const Eigen::Vector2i& camera) const;
};
VideoPixels PixelsOf(const VideoInfo& video);

/// Moves observations to the camera's pixels if VideoPixels::Differ(); returns true if it did.
template <typename Sequence>
bool MoveToCamera(const VideoPixels& video, const Camera& camera, Sequence* seen);

}  // namespace bodyloom
