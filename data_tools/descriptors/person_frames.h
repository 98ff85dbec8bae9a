// SPDX-License-Identifier: Apache-2.0
/// A tracked person as the appearance renderers see it: in a window around the body, the surface coordinates of every
/// pixel, and over the UV atlas the surface's normals and velocities.
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
  int past = 10;         ///< velocities of so many frames
  SurfaceMotion motion;  ///< axes and velocities of the motion maps
  PersonWindowOptions window;
  /// By frame: turns the view about the vertical (the camera's y) through the body's root, degrees; empty: the track's
  /// own view. The motion is turned with it (about the same vertical in world axes; body axes know of no view), so that
  /// a view that moves adds no velocity of its own.
  std::vector<double> yaw_deg;
  /// Which frame of the track is shown when (geometry/scene/track_edits.h); empty: each in turn. One that is shown
  /// again moves as it did the first time: time stands still, nothing comes to rest. All that is by frame here is by
  /// frame shown.
  std::vector<int> shown;
  std::string scratch_dir;  ///< the maps lie in a file without a name here; empty: the system's own place
  int num_threads = 1;
};

class PersonFrames {
 public:
  static constexpr double kBodyLength = 1.7;  ///< metres: velocities are in body lengths a second
  static constexpr float kMaxSpeed = 5;       ///< and cut off at so many

  /// Describes all frames (data_tools/descriptors/describe_track.h): 12 bytes a texel and frame, on the disk; memory is
  /// used as far as there is some (data_tools/formats/mapped_npy.h). Throws std::invalid_argument when the track is not
  /// the body's or no frame has a result; std::runtime_error when the scratch file cannot be written. Keeps references
  /// to body and track.
  PersonFrames(const BodyModel& body, const Track& track, const PersonFramesOptions& options);
  ~PersonFrames();
  PersonFrames(const PersonFrames&) = delete;
  PersonFrames& operator=(const PersonFrames&) = delete;

  [[nodiscard]] int num_frames() const;
  [[nodiscard]] int channels() const;  ///< of the motion maps: 3 + 3·past
  [[nodiscard]] const PersonWindow& window() const;
  [[nodiscard]] const PersonFramesOptions& options() const;
  [[nodiscard]] const Track& track() const;  ///< as it is shown

  /// Number of the track's gap-free run of frames that frame t belongs to; −1: it has no result.
  [[nodiscard]] int Segment(int t) const;

  /// [N_t, V_t, V_{t−1}, …] of the posed surface in the axes of options().motion, channels × uv_size × uv_size: unit
  /// normals, and velocities in body lengths a second; zero where there is no frame to look back to. A frame without a
  /// result is zero.
  void MotionMaps(int t, std::span<float> maps) const;

  /// What the pixels of frame t's window see of the body: atlas coordinates (2 × height × width, 0 elsewhere) and a
  /// mask (height × width). May be called by several threads.
  void BodyMaps(int t, std::span<float> uv, std::span<float> mask) const;

  /// Which part of the body they see and its normal in the camera's axes. Of a frame without a result: nothing. May be
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
