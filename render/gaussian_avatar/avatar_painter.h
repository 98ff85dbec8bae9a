// SPDX-License-Identifier: Apache-2.0
/// Renders a person of Gaussians from the body's pose to pixels, and backpropagates derivatives.
#pragma once

#include <array>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/pose_gradient.h"
#include "render/splat/project_gaussians.h"
#include "render/splat/splat_gradient.h"

namespace bodyloom {

/// View in which a person is rendered.
struct AvatarView {
  Camera camera;                 ///< without distortion
  PixelBox window;               ///< pixels to render
  PoseGaussiansOptions options;  ///< light and threads; the latter for all stages
};

/// Keeps its memory between images. Not for use by two threads at once.
class AvatarPainter {
 public:
  /// Renders the person in a frame. Throws as PoseGaussians, ProjectGaussians and SplatImage::Draw.
  void Draw(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame, const AvatarView& view);

  [[nodiscard]] const SplatImage& image() const { return image_; }
  /// Share, in [0, 1], of Gaussians of one kind in each pixel of the window last drawn from `body`.
  [[nodiscard]] std::vector<float> ShareOf(GaussianKind kind, const GaussianBody& body);
  [[nodiscard]] const ScreenGaussians& screen() const { return screen_; }
  [[nodiscard]] const CameraGaussians& posed() const { return posed_; }

  /// Computes the gradient from d loss / d planes of the image last drawn, with the same arguments as Draw().
  void GoBack(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame, const AvatarView& view,
              const FloatColumns& by_planes, AvatarGradient* gradient);
  /// Derivatives by the Gaussians on the screen, from the last backward pass.
  [[nodiscard]] const FloatColumns& by_screen() const { return by_screen_; }

 private:
  CameraGaussians posed_;
  ScreenGaussians screen_;
  SplatImage image_;
  SplatGradient splat_gradient_;
  PoseGradient pose_gradient_;
  FloatColumns by_screen_, by_posed_;
};

}  // namespace bodyloom
