// SPDX-License-Identifier: Apache-2.0
/// A person of Gaussians in a motion as one HTML file that opens from disk: turned, brought nearer and scrubbed by
/// hand, posed, lit, sorted and drawn in the page (assets/page/avatar.js, WebGL 2). Nothing is fetched from elsewhere.
///
/// The page poses as render/gaussian_avatar/pose_gaussians.h does. What moves a Gaussian beyond its bones (pose
/// correctives) is stored in bytes for key frames, as many as 16 MB hold, and interpolated between them. Bones are 48
/// bytes each in every frame: of a clip whose bones take more than 16 MB, every second, third, … frame is shown.
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
  /// Every so many-th frame of a clip is shown.
  [[nodiscard]] static int FrameStep(int num_frames, int num_bones);

  /// Of a person shown in `num_frames` frames by a pinhole camera without distortion. Keeps references to body and
  /// faces. `up_in_camera`: the axis about which the page turns.
  AvatarPage(const GaussianBody& body, const MatrixX3i& faces, const Camera& camera,
             const Eigen::Vector3d& up_in_camera, int num_frames);

  /// The next frame, `seconds` after the first one: bones, and all Gaussians in the camera's frame.
  void AddFrame(double seconds, const AvatarFrame& frame, const CameraGaussians& posed);
  /// The next frame, in which nobody is shown.
  void AddEmptyFrame(double seconds);

  /// Throws std::invalid_argument when no frame shows the person.
  [[nodiscard]] std::string ToHtml(const std::string& title, const std::string& subtitle) const;

 private:
  /// Whether what moves Gaussians beyond their bones is stored for this frame.
  [[nodiscard]] bool IsKey(int frame) const { return frame % key_interval_ == 0 || frame + 1 == num_frames_; }

  const GaussianBody& body_;
  const MatrixX3i& faces_;
  AvatarFrame bones_alone_;   ///< of the frame: no correctives
  CameraGaussians on_bones_;  ///< where these take the Gaussians
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
