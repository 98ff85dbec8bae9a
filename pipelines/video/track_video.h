// SPDX-License-Identifier: Apache-2.0
/// The video that a track was made from, frame by frame of the track, and the track moved into its pixels.
#pragma once

#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"
#include "data_tools/video/video_reader.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Throws std::runtime_error when the video's size fits neither the camera nor a scaled copy of it.
class TrackVideo {
 public:
  /// `map`: from the camera's pixels to the video's, when it says more than identity. video_offset: the video frame of
  /// the track's time zero.
  TrackVideo(const std::string& path, const Track& track, const Matrix2x3d& map = NamedCamera().video_px_from_camera_px,
             int video_offset = 0);

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// What was wrong with the video so far (VideoReader::warning); "" when nothing was.
  [[nodiscard]] std::string warning() const { return reader_.warning(); }
  /// From pixels of the track's camera to those of the video.
  [[nodiscard]] const Matrix2x3d& map() const { return map_; }
  /// The track as a camera with the video's pixels would have seen it.
  [[nodiscard]] Track Moved(Track track) const;

  /// The video frame shown at a time of the track, seconds; null before its beginning and past its end. Times must not
  /// fall by more than a frame.
  const Image* At(double time_s);
  /// How many frames the video has after the one shown at that time; 0 when it does not say how long it is.
  [[nodiscard]] int FramesAfter(double time_s) const;

 private:
  [[nodiscard]] int IndexAt(double time_s) const;

  VideoReader reader_;
  Matrix2x3d map_;
  std::vector<double> times_;  ///< when each frame of the video is shown, seconds; empty for a folder of images
  double fps_ = 30;
  int offset_ = 0;
  Image frame_;
  bool has_frame_ = false;
};

/// From pixels of a camera to those of a video of width × height: `map` where it is more than identity, else the scale
/// between the two. Throws std::runtime_error naming `path` when the video is no scaled copy of what the camera saw.
Matrix2x3d VideoFromCameraPixels(const Matrix2x3d& map, const Camera& camera, int width, int height,
                                 const std::string& path);

/// Frames a second of a video whose frames have these timestamps: 1 / their median step, within [1, 240]; 30 for one
/// frame.
double VideoFrameRate(const std::vector<double>& timestamps);

}  // namespace bodyloom
