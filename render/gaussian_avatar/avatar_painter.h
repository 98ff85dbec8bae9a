// SPDX-License-Identifier: Apache-2.0
/// A person of Gaussians in a picture, from the body's pose to pixels, and the way back of derivatives.
#pragma once

#include <array>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/pose_gradient.h"
#include "render/splat/project_gaussians.h"
#include "render/splat/splat_gradient.h"

namespace bodyloom {

/// How a person is looked at.
struct AvatarView {
  Camera camera;                 ///< without distortion
  PixelBox window;               ///< what is drawn of the picture
  PoseGaussiansOptions options;  ///< light and threads; the latter for all stages
};

/// Keeps its memory between pictures. Not for use by two threads at once.
class AvatarPainter {
 public:
  /// Throws as PoseGaussians, ProjectGaussians and SplatPicture::Draw.
  void Draw(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame, const AvatarView& view);

  [[nodiscard]] const SplatPicture& picture() const { return picture_; }
  /// Of the picture last drawn, a number a pixel of the window: how much of it is Gaussians of a kind of `body`, which
  /// was drawn, in [0, 1].
  [[nodiscard]] std::vector<float> ShareOf(GaussianKind kind, const GaussianBody& body);
  [[nodiscard]] const ScreenGaussians& screen() const { return screen_; }
  [[nodiscard]] const CameraGaussians& posed() const { return posed_; }

  /// From d loss / d planes of what was last drawn, with the same arguments.
  void GoBack(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame, const AvatarView& view,
              const FloatColumns& by_planes, AvatarGradient* gradient);
  /// By the Gaussians on the screen, of the last GoBack().
  [[nodiscard]] const FloatColumns& by_screen() const { return by_screen_; }

 private:
  CameraGaussians posed_;
  ScreenGaussians screen_;
  SplatPicture picture_;
  SplatGradient splat_gradient_;
  PoseGradient pose_gradient_;
  FloatColumns by_screen_, by_posed_;
};

}  // namespace bodyloom
