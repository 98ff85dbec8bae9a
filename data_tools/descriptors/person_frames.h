// SPDX-License-Identifier: Apache-2.0
/// Inputs of the appearance renderers from a tracked person: surface coordinates of every pixel of a window around the
/// body, and normals and velocities of the surface over the UV atlas.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/datasets/body_truth.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "geometry/uv_maps/descriptor_options.h"
#include "render/view/person_window.h"

namespace bodyloom {

struct PersonFramesOptions {
  int uv_size = 128;     ///< of the motion maps
  int past = 10;         ///< number of frames with velocities
  SurfaceMotion motion;  ///< axes and velocities of the motion maps
  PersonWindowOptions window;
  /// Per frame, the rotation of the view about the vertical (the camera's y) through the body's root, degrees; empty:
  /// the track's own view. The motion is rotated with it (about the same vertical in world axes; body axes do not
  /// depend on the view), so that a moving view adds no velocity.
  std::vector<double> yaw_deg;
  /// Frames of the track in the order in which they are shown (geometry/scene/track_edits.h); empty: each in turn. A
  /// repeated frame keeps its velocities: time stops, nothing comes to rest. Frame indices of this class are those of
  /// the shown frames.
  std::vector<int> shown;
  std::string scratch_dir;  ///< folder of the unnamed file that holds the maps; empty: the system's default
  int num_threads = 1;
};

class PersonFrames {
 public:
  static constexpr double kBodyLength = 1.7;  ///< metres: velocities are in body lengths per second
  static constexpr float kMaxSpeed = 5;       ///< at which they are clamped

  /// Describes all frames (data_tools/descriptors/describe_track.h): 12 bytes per texel and frame on disk, cached in
  /// memory as far as available (data_tools/formats/npy_stream.h). Throws std::invalid_argument when the track does not
  /// fit the body or no frame has a result; std::runtime_error when the scratch file cannot be written. Keeps
  /// references to body and track.
  PersonFrames(const BodyModel& body, const Track& track, const PersonFramesOptions& options);
  ~PersonFrames();
  PersonFrames(const PersonFrames&) = delete;
  PersonFrames& operator=(const PersonFrames&) = delete;

  [[nodiscard]] int num_frames() const;
  [[nodiscard]] int channels() const;  ///< of the motion maps: 3 + 3·past
  [[nodiscard]] const PersonWindow& window() const;
  [[nodiscard]] const PersonFramesOptions& options() const;
  [[nodiscard]] const Track& track() const;  ///< as shown

  /// Number of the track's gap-free run of frames that frame t belongs to; −1: it has no result.
  [[nodiscard]] int Segment(int t) const;

  /// [N_t, V_t, V_{t−1}, …] of the posed surface in the axes of options().motion, channels × uv_size × uv_size: unit
  /// normals, and velocities in body lengths per second; zero where there is no previous frame. A frame without a
  /// result is zero.
  void MotionMaps(int t, std::span<float> maps) const;

  /// Writes the body's atlas coordinates (2 × height × width, 0 elsewhere) and a mask (height × width) of frame t's
  /// window. May be called by several threads.
  void BodyMaps(int t, std::span<float> uv, std::span<float> mask) const;

  /// Body part and normal (camera axes) of the pixels of frame t's window; empty for a frame without a result. May be
  /// called by several threads. Throws std::invalid_argument when the body has no charts.
  [[nodiscard]] BodySurface Surface(int t) const;

  /// The 17 keypoints of COCO (CocoNames, geometry/scene/observations.h) of frame t's body, pixels of its window, 17×2;
  /// NaN for those behind the camera and for a frame without a result. May be called by several threads. Throws
  /// std::invalid_argument when the body lacks one.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 2> Keypoints(int t) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
