// SPDX-License-Identifier: Apache-2.0
/// Writes a Gaussian avatar in a motion as one self-contained HTML file that opens from disk. The page lets the user
/// turn, zoom and scrub, and does posing, lighting, sorting and drawing itself (assets/page/avatar.js, WebGL 2).
///
/// The page poses as render/gaussian_avatar/pose_gaussians.h does. Pose correctives, which move a Gaussian beyond its
/// bones, are stored in bytes at key frames (as many as fit in 16 MB) and interpolated between them. Bones take 48
/// bytes each per frame; a clip whose bones exceed 16 MB is shown at every second, third, … frame.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/avatar_frame.h"
#include "render/gaussian_avatar/gaussian_body.h"
#include "render/splat/camera_gaussians.h"

namespace bodyloom {

class AvatarPage {
 public:
  /// Step between the frames of a clip that are shown.
  [[nodiscard]] static int FrameStep(int num_frames, int num_bones);

  /// A page of a person in `num_frames` frames, seen by a pinhole camera without distortion. Keeps references to body
  /// and faces. `up_in_camera`: the axis about which the page turns.
  AvatarPage(const GaussianBody& body, const MatrixX3i& faces, const Camera& camera,
             const Eigen::Vector3d& up_in_camera, int num_frames);

  /// Adds the next frame, `seconds` after the first one: bones, and all Gaussians in the camera's frame.
  void AddFrame(double seconds, const AvatarFrame& frame, const CameraGaussians& posed);
  /// Adds the next frame without a person.
  void AddEmptyFrame(double seconds);

  /// Throws std::invalid_argument when no frame shows the person.
  [[nodiscard]] std::string ToHtml(const std::string& title, const std::string& subtitle) const;

 private:
  /// True if the frame is a key frame, which stores pose correctives.
  [[nodiscard]] bool IsKey(int frame) const { return frame % key_interval_ == 0 || frame + 1 == num_frames_; }

  const GaussianBody& body_;
  const MatrixX3i& faces_;
  AvatarFrame bones_alone_;   ///< of the frame, without correctives
  CameraGaussians on_bones_;  ///< Gaussians posed by bones_alone_
  Camera camera_;
  Eigen::Vector3d up_in_camera_;
  int num_frames_, num_gaussians_, key_interval_;
  std::vector<float> gaussians_;  ///< columns of assets/page/avatar.js
  std::vector<double> seconds_;
  std::vector<float> bones_;     ///< frames × J × 12; NaN where nobody is shown
  std::vector<int8_t> changes_;  ///< key frames × 3 × Gaussians
  size_t num_joints_ = 0;
};

}  // namespace bodyloom
