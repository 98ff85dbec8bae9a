// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_losses.h"

#include "geometry/base/check.h"
#include "neural/losses/image_losses.h"

namespace bodyloom {

using torch::Tensor;

namespace {

constexpr int kSmallestFace = 16;

}  // namespace

Tensor TextureLoss(const Tensor& features, const TextureTensors& source, const TextureTensors& target) {
  const Tensor colour = features.slice(1, 0, 3);
  return MaskedL1Loss(colour, source.colour, source.visible) + MaskedL1Loss(colour, target.colour, target.visible);
}

Tensor FaceLoss(SphereFace network, const Tensor& image, const Tensor& truth, const std::vector<PhotoWindow>& faces) {
  BODYLOOM_CHECK(image.sizes() == truth.sizes() && static_cast<int64_t>(faces.size()) == image.size(0),
                 "face loss: images of shapes ", image.sizes(), " and ", truth.sizes(), " with ", faces.size(),
                 " faces");
  std::vector<Tensor> made, real;
  for (size_t b = 0; b < faces.size(); ++b) {
    const PhotoWindow& box = faces[b];
    if (box.width < kSmallestFace || box.height < kSmallestFace) continue;
    const auto face = [&](const Tensor& images) {
      const auto at = static_cast<int64_t>(b);
      const Tensor cut =
          images.slice(0, at, at + 1).slice(2, box.y, box.y + box.height).slice(3, box.x, box.x + box.width);
      return torch::upsample_bilinear2d(cut, {kFaceHeight, kFaceWidth}, /*align_corners=*/false);
    };
    made.push_back(face(image));
    real.push_back(face(truth));
  }
  if (made.empty()) return torch::zeros({}, image.options());
  Tensor target;
  {
    const torch::NoGradGuard no_grad;
    target = network(torch::cat(real, 0));
  }
  return L1Loss(network(torch::cat(made, 0)), target);
}

}  // namespace bodyloom
