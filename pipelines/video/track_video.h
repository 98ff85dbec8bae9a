// SPDX-License-Identifier: Apache-2.0
/// Reads the video of a track at the track's frames, and transforms the track to the video's pixels.
#pragma once

#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"
#include "data_tools/video/video_reader.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Video of a track, played as the track says (VideoPlayback). Throws std::runtime_error when the video's size matches
/// neither the camera nor a scaled copy of it.
class TrackVideo {
 public:
  /// `map`: from the camera's pixels to the video's, used if it is not the identity. video_offset: the video frame of
  /// the track's time zero.
  TrackVideo(const std::string& path, const Track& track, const Matrix2x3d& map = NamedCamera().video_px_from_camera_px,
             int video_offset = 0);

  [[nodiscard]] const VideoInfo& info() const { return reader_.info(); }
  /// Warning about the video so far (VideoReader::warning); "" without one.
  [[nodiscard]] std::string warning() const { return reader_.warning(); }
  /// From pixels of the track's camera to those of the video.
  [[nodiscard]] const Matrix2x3d& map() const { return map_; }
  /// The track as seen by a camera with the video's pixels.
  [[nodiscard]] Track Moved(Track track) const;

  /// The video frame at a time of the track, seconds; null before the start and after the end of the video. Successive
  /// times must not decrease by more than a frame.
  const Image* At(double time_s);
  /// Number of frames of the video after the one at that time; 0 if its length is unknown.
  [[nodiscard]] int FramesAfter(double time_s) const;

 private:
  [[nodiscard]] int IndexAt(double time_s) const;

  VideoReader reader_;
  Matrix2x3d map_;
  std::vector<double> times_;  ///< when each frame of the video is shown, seconds; empty for a folder of images
  double fps_ = 30;            ///< as played
  double slowdown_ = 1;
  int offset_ = 0;
  Image frame_;
  bool has_frame_ = false;
};

/// Map from pixels of a camera to those of a video of width × height: `map` if it is not the identity, else the scale
/// between the two. Throws std::runtime_error naming `path` when the video is not a scaled copy of the camera's image.
Matrix2x3d VideoFromCameraPixels(const Matrix2x3d& map, const Camera& camera, int width, int height,
                                 const std::string& path);
/// The same for a video, which is also a copy of the camera's image when the latter has the video's stored pixels, as
/// that of a calibration by programs that take them for square: their sides are then scaled differently. A
/// weak-perspective camera has square pixels.
Matrix2x3d VideoFromCameraPixels(const Matrix2x3d& map, const Camera& camera, const VideoInfo& video,
                                 const std::string& path);

/// Maps pixels of an image of `from` to those of an image of `to` that shows the same, both width × height.
Matrix2x3d ScaleOfPixels(const Eigen::Vector2i& from, const Eigen::Vector2i& to);

/// The camera whose image of width × height shows at map · (p, 1) what that of `camera` shows at p. The map's shear is
/// left out: 0.2 px at the border for 2e-4, as in real files.
Camera CameraOfMappedPixels(Camera camera, const Matrix2x3d& map, int width, int height);

/// The rate at which a video is played: its own, else `fps` if above 0, else 30.
double PlayedFps(const VideoInfo& video, double fps = 0);

/// The way to play a video whose frames are turned clockwise by `turn_deg` and, if `captured_fps` > 0, were taken at
/// that rate. `fps`: as in PlayedFps().
VideoPlayback PlaybackOf(const VideoInfo& video, int turn_deg, double captured_fps, double fps = 0);

/// Frame rate of a video from its timestamps: 1 / median step, clamped to [1, 240]; 30 for one frame.
double VideoFrameRate(const std::vector<double>& timestamps);

}  // namespace bodyloom
