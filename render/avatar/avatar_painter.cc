// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/avatar_painter.h"

namespace bodyloom {

void AvatarPainter::Draw(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                         const GaussianOffsets& offsets, const AvatarView& view) {
  PoseGaussians(body, faces, frame, offsets, view.options, &posed_);
  ProjectGaussians(posed_, view.camera, {.num_threads = view.options.num_threads}, &screen_);
  picture_.Draw(screen_, view.window, {.num_threads = view.options.num_threads});
}

void AvatarPainter::GoBack(const GaussianBody& body, const MatrixX3i& faces, const AvatarFrame& frame,
                           const GaussianOffsets& offsets, const AvatarView& view, const FloatColumns& by_planes,
                           AvatarGradient* gradient) {
  const int threads = view.options.num_threads;
  splat_gradient_.Compute(picture_, screen_, by_planes, threads, &by_screen_);
  ProjectGaussiansBackward(posed_, screen_, by_screen_, view.camera, {.num_threads = threads}, &by_posed_);
  pose_gradient_.Compute(body, faces, frame, offsets, view.options, by_posed_, gradient);
}

}  // namespace bodyloom
