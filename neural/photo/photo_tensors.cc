// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_tensors.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "neural/base/device.h"

namespace bodyloom {

using torch::Tensor;

namespace {

/// B×channels×h×w from a planar field of each frame, cut to the windows.
template <typename T>
Tensor Cut(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows, std::vector<T> PhotoFrame::*field,
           const char* name, int64_t channels) {
  BODYLOOM_CHECK(!frames.empty() && frames.size() == windows.size(), "photo renderer: ", frames.size(), " frames with ",
                 windows.size(), " windows");
  const int64_t w = windows[0].width, h = windows[0].height;
  Tensor result = torch::empty({static_cast<int64_t>(frames.size()), channels, h, w});
  float* to = result.data_ptr<float>();
  for (size_t b = 0; b < frames.size(); ++b) {
    const int64_t S = frames[b].size;
    const std::vector<T>& values = frames[b].*field;
    const PhotoWindow& window = windows[b];
    BODYLOOM_CHECK(static_cast<int64_t>(values.size()) == channels * S * S, "photo renderer: a frame has ",
                   values.size(), " values of ", name, ", expected ", channels, "x", S, "x", S);
    BODYLOOM_CHECK(window.width == w && window.height == h && window.x >= 0 && window.y >= 0 && window.x + w <= S &&
                       window.y + h <= S,
                   "photo renderer: a window of ", window.width, "x", window.height, " at ", window.x, ", ", window.y,
                   " in a frame of ", S, "x", S, ", expected one of ", w, "x", h, " inside it");
    for (int64_t c = 0; c < channels; ++c) {
      for (int64_t y = 0; y < h; ++y, to += w) {
        std::copy_n(values.begin() + ((c * S + window.y + y) * S + window.x), w, to);
      }
    }
  }
  return OnDevice(result);
}

}  // namespace

TextureTensors ToTensors(std::span<const PartialTexture> textures) {
  BODYLOOM_CHECK(!textures.empty(), "photo renderer: no textures");
  const auto B = static_cast<int64_t>(textures.size());
  const int64_t U = textures[0].size;
  const Tensor rgb = torch::empty({B, 3, U, U}), visible = torch::empty({B, 1, U, U});
  Tensor guessed;  // undefined without guesses
  for (int64_t b = 0; b < B; ++b) {
    const PartialTexture& texture = textures[b];
    BODYLOOM_CHECK(texture.size == U && static_cast<int64_t>(texture.colour.size()) == 3 * U * U &&
                       static_cast<int64_t>(texture.visible.size()) == U * U,
                   "photo renderer: a texture of ", texture.size, " texels a side, expected ", U);
    std::copy(texture.colour.begin(), texture.colour.end(), rgb.data_ptr<float>() + b * 3 * U * U);
    std::copy(texture.visible.begin(), texture.visible.end(), visible.data_ptr<float>() + b * U * U);
    if (texture.guessed.empty()) continue;
    BODYLOOM_CHECK(texture.guessed.size() == texture.visible.size(), "photo renderer: guesses at ",
                   texture.guessed.size(), " texels, expected ", U, "²");
    if (!guessed.defined()) guessed = torch::zeros({B, 1, U, U});
    std::copy(texture.guessed.begin(), texture.guessed.end(), guessed.data_ptr<float>() + b * U * U);
  }
  const Tensor colour = 2 * OnDevice(rgb) - 1, shown = OnDevice(visible);
  return {colour * shown, shown, guessed.defined() ? colour * OnDevice(guessed) : Tensor()};
}

PoseTensors PoseOf(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows) {
  PoseTensors pose;
  pose.uv = Cut(frames, windows, &PhotoFrame::uv, "surface coordinates", 2);
  const Tensor parts = Cut(frames, windows, &PhotoFrame::parts, "parts", 1);
  pose.parts = parts / (kPhotoParts - 1);
  pose.body = (parts > 0).to(torch::kFloat);
  return pose;
}

ImageTensors ImageTensorsOf(std::span<const PhotoFrame> frames, std::span<const PhotoWindow> windows) {
  ImageTensors tensors;
  tensors.image = Cut(frames, windows, &PhotoFrame::image, "the tensors", 3);
  const bool labelled =
      std::none_of(frames.begin(), frames.end(), [](const PhotoFrame& frame) { return frame.labels.empty(); });
  const Tensor shown =
      labelled ? Cut(frames, windows, &PhotoFrame::labels, "labels", 1) : tensors.image.amax(1, /*keepdim=*/true);
  tensors.foreground = (shown > 0).to(torch::kFloat);
  return tensors;
}

}  // namespace bodyloom
