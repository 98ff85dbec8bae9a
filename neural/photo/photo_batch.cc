// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_batch.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "neural/losses/image_losses.h"
#include "render/texture/complete/partial_texture.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr int kSmallestFace = 16;

/// The part of `box` inside `window`, in coordinates of the window; width 0 if there is none.
PhotoWindow Inside(const PhotoWindow& box, const PhotoWindow& window) {
  const int left = std::max(box.x, window.x), right = std::min(box.x + box.width, window.x + window.width);
  const int top = std::max(box.y, window.y), bottom = std::min(box.y + box.height, window.y + window.height);
  if (right <= left || bottom <= top) return {};
  return {left - window.x, top - window.y, right - left, bottom - top};
}

}  // namespace

PhotoBatch MakePhotoBatch(const PhotoSource& source, std::span<const PhotoPair> pairs, int reach, int smallest_side,
                          const TexelNeighbours* guess, std::span<const uint8_t> back_of_head) {
  std::vector<PartialTexture> from, to;
  std::vector<PhotoFrame> targets;
  std::vector<PhotoWindow> windows;
  PhotoFrame frame;
  for (const PhotoPair& pair : pairs) {
    source.fill(pair.person, pair.source, &frame);
    from.push_back(PartialTextureOf(frame));
    if (guess != nullptr) GuessTexture(*guess, &from.back());
    targets.emplace_back();
    source.fill(pair.person, pair.target, &targets.back());
    to.push_back(PartialTextureOf(targets.back()));
    windows.push_back(WindowAround(targets.back(), reach, smallest_side));
  }
  windows = EqualWindows(windows, source.size);
  PhotoBatch batch;
  batch.source = ToTensors(from);
  batch.target = ToTensors(to);
  batch.pose = PoseOf(targets, windows);
  batch.truth = ImageTensorsOf(targets, windows);
  for (size_t i = 0; i < targets.size() && !back_of_head.empty(); ++i) {
    batch.faces.push_back(Inside(FaceBox(targets[i], back_of_head), windows[i]));
  }
  return batch;
}

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
