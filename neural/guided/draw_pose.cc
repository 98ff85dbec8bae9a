// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/draw_pose.h"

#include "geometry/base/check.h"
#include "neural/guided/guided_tensors.h"

namespace bodyloom {

using torch::Tensor;

RenderedPerson DrawGuided(GuidedModel* model, const GuidedSource& source, const PhotoFrame& frame,
                          const PseudoImage& pseudo, int reach, double* share) {
  GuidedModelImpl& networks = **model;
  const int size = networks.config.profile.image_size, multiple = networks.config.Multiple();
  BODYLOOM_CHECK(frame.size == size && pseudo.size == size, "pose-guided renderer: a frame of ", frame.size,
                 " px and pseudo inputs of ", pseudo.size, ", expected ", size);
  const torch::NoGradGuard no_grad;
  PhotoFrame pose;  // without the image, on which the box must not depend
  pose.size = size;
  pose.parts = frame.parts;
  const std::span<const PhotoFrame> one(&pose, 1);
  CodeBox box = PersonBox(pose, multiple, reach);
  const bool somebody = box.width > 0;
  if (reach <= 0) box = {0, 0, size / multiple, size / multiple};
  if (share != nullptr) {
    *share = somebody ? static_cast<double>(box.width * box.height * multiple * multiple) / (double(size) * size) : 0;
  }
  const size_t pixels = size_t(size) * size;
  if (!somebody)
    return {size, std::vector<float>(3 * pixels), std::vector<float>(pixels), std::vector<uint8_t>(pixels)};
  const Tensor pose_map = CroppedPixels(TensorsOf(one).pose, box, multiple);
  const GuidedPseudo known = CroppedPixels(PseudoOf(std::span(&pseudo, 1)), box, multiple);
  GuidedResult result = networks.forward(source, pose_map, known, box);
  if (reach > 0) {
    const Tensor body = (pose_map.amax(1, true) > 0).to(torch::kFloat);
    // Separable dilation by squares: maximum over columns, then over rows.
    const Tensor near = torch::max_pool2d(torch::max_pool2d(body, {1, 2 * reach + 1}, 1, {0, reach}),
                                          {2 * reach + 1, 1}, 1, {reach, 0});
    result.image = result.image * near;
    result.silhouette = result.silhouette * near;
  }
  return RenderedPersonOf(result, known, 0, box, multiple, size);
}

}  // namespace bodyloom
