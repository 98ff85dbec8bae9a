// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/training_view.h"

#include <algorithm>

namespace bodyloom {

TrainingView CutTrainingView(const Image& image, const PersonAt& person_at, const PixelBox& search,
                             const PixelBox& body, int margin) {
  const PixelBox whole = {0, 0, image.width, image.height}, seen = search.ClippedTo(whole);
  TrainingView view;
  PixelBox box = body.ClippedTo(whole);
  if (box.empty()) box = {image.width, image.height, 0, 0};
  for (int y = seen.y_begin; y < seen.y_end; ++y) {
    for (int x = seen.x_begin; x < seen.x_end; ++x) {
      if (person_at(x, y) == 0) continue;
      ++view.person_pixels;
      box = {std::min(box.x_begin, x), std::min(box.y_begin, y), std::max(box.x_end, x + 1),
             std::max(box.y_end, y + 1)};
    }
  }
  if (view.person_pixels == 0) return view;
  view.window = box.GrownBy(margin).ClippedTo(whole);
  view.pixels.resize(4 * view.window.area());
  for (int y = view.window.y_begin; y < view.window.y_end; ++y) {
    for (int x = view.window.x_begin; x < view.window.x_end; ++x) {
      uint8_t* to = view.pixels.data() + 4 * view.window.IndexOf(x, y);
      std::copy_n(image.pixel(x, y), 3, to);
      to[3] = seen.Contains(x, y) ? person_at(x, y) : 0;
    }
  }
  return view;
}

void FillTruth(const TrainingView& view, ImageTruth* truth) {
  truth->width = view.window.width(), truth->height = view.window.height();
  truth->person_pixels = std::max(1, view.person_pixels);
  const auto area = static_cast<int>(view.window.area());
  truth->planes.Resize(4, area);
  for (int c = 0; c < 3; ++c) {
    float* plane = truth->planes.column(c);
    for (int i = 0; i < area; ++i) {
      const uint8_t* pixel = view.pixels.data() + 4 * static_cast<size_t>(i);
      plane[i] = pixel[3] != 0 ? static_cast<float>(pixel[2 - c]) * (1.0F / 255) : 0;
    }
  }
  float* alpha = truth->planes.column(3);
  for (int i = 0; i < area; ++i) alpha[i] = view.pixels[4 * static_cast<size_t>(i) + 3] != 0 ? 1.0F : 0.0F;
}

}  // namespace bodyloom
