// SPDX-License-Identifier: Apache-2.0
/// One frame as the motion-dependent renderer takes it: a window around the person, and the motion maps of its body.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace bodyloom {

/// Images are planar (channel, row, column). What is unknown is empty.
struct MotionFrame {
  int width = 0, height = 0;  ///< of the window
  /// The window of frame t − 1 lies at (before_x, before_y) in this one: the pixel that (x, y) of that window shows is
  /// (x + before_x, y + before_y) of this.
  int before_x = 0, before_y = 0;

  // One of both, as the configuration's descriptor is.
  std::vector<float> motion;  ///< channels × U × U: normals and velocities in UV
  std::vector<float> dense;   ///< channels × height × width: dense UV and keypoints of the last frames
  std::vector<float> uv;      ///< 2 × height × width, the body's atlas coordinates in [0, 1]
  std::vector<float> body;    ///< height × width: 1 where a pixel shows the body

  // Truth.
  std::vector<float> image;     ///< 3 × height × width in [0, 1], RGB, 0 on the background
  std::vector<uint8_t> labels;  ///< height × width; 0: background
  std::vector<float> normals;   ///< 3 × height × width unit normals in the camera frame, 0 on the background
};

/// Fills frame t of a clip; truth only when requested. Called from one thread other than the caller's.
using MotionFrameSource = std::function<void(int t, bool with_truth, MotionFrame* frame)>;

}  // namespace bodyloom
