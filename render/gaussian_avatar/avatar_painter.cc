// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/avatar_painter.h"

#include <span>

namespace bodyloom {

void AvatarPainter::Draw(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                         const AvatarView& view) {
  PoseGaussians(body, faces, frame, view.options, &posed_);
  ProjectGaussians(posed_, view.camera, {.num_threads = view.options.num_threads}, &screen_);
  image_.Draw(screen_, view.window, {.num_threads = view.options.num_threads});
}

std::vector<float> AvatarPainter::ShareOf(GaussianKind kind, const GaussianBody& body) {
  FloatColumns of_kind(3, body.size()), planes;
  of_kind.Fill(0);
  for (int i = 0; i < body.size(); ++i) of_kind(i, 0) = body.kinds[i] == kind ? 1.0F : 0.0F;
  image_.DrawValues(of_kind, &planes);
  const std::span<const float> share = planes.values(0);
  return {share.begin(), share.end()};
}

void AvatarPainter::GoBack(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                           const AvatarView& view, const FloatColumns& by_planes, AvatarGradient* gradient) {
  const int threads = view.options.num_threads;
  splat_gradient_.Compute(image_, screen_, by_planes, threads, &by_screen_);
  ProjectGaussiansBackward(posed_, screen_, by_screen_, view.camera, {.num_threads = threads}, &by_posed_);
  pose_gradient_.Compute(body, faces, frame, view.options, by_posed_, gradient);
}

}  // namespace bodyloom
