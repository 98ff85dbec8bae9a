// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/render_photo.h"

#include <algorithm>
#include <span>
#include <vector>

#include "neural/base/device.h"

namespace bodyloom {

RenderedPerson RenderPhoto(PhotoModel model, const torch::Tensor& features, const PhotoFrame& pose, int reach) {
  const torch::NoGradGuard no_grad;
  const int S = pose.size;
  const size_t pixels = static_cast<size_t>(S) * S;
  RenderedPerson rendered;
  rendered.size = S;
  rendered.image.assign(3 * pixels, 0);
  rendered.alpha.assign(pixels, 0);
  if (std::all_of(pose.parts.begin(), pose.parts.end(), [](uint8_t part) { return part == 0; })) return rendered;
  const PhotoWindow window =
      reach < 0 ? PhotoWindow{0, 0, S, S} : WindowAround(pose, reach, model->config.SmallestSide());
  const PoseTensors seen = PoseOf(std::span(&pose, 1), std::span(&window, 1));
  const PhotoResult result = model->Render(model->Project(features, seen), seen.body);
  const auto paste = [&](const torch::Tensor& tensor, std::vector<float>* planar) {
    const std::vector<float> whole = HostValues<float>(tensor);
    auto from = whole.begin();
    for (int64_t c = 0; c < tensor.size(1); ++c) {
      for (int y = 0; y < window.height; ++y, from += window.width) {
        std::copy_n(from, window.width, planar->begin() + ((c * S + window.y + y) * S + window.x));
      }
    }
  };
  paste(result.image, &rendered.image);
  paste(result.alpha, &rendered.alpha);
  return rendered;
}

}  // namespace bodyloom
