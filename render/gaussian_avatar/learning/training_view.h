// SPDX-License-Identifier: Apache-2.0
/// Training frame of a person of Gaussians.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/avatar_frame.h"
#include "render/gaussian_avatar/learning/image_loss.h"
#include "render/image/image.h"
#include "render/image/pixel_box.h"

namespace bodyloom {

struct TrainingView {
  int time = 0;  ///< frame of the clip
  AvatarFrame frame;
  /// The garment's bones, K×12 each, from other runs of its simulation; training cycles through the runs each time the
  /// view is visited.
  std::vector<std::vector<float>> other_cloth;
  Camera camera;                ///< without distortion
  PixelBox window;              ///< around the person, inside the image
  std::vector<uint8_t> pixels;  ///< of the window, row-major: blue, green, red, PersonAt
  int person_pixels = 0;

  [[nodiscard]] bool ShowsPerson(int x, int y) const {
    return window.Contains(x, y) && pixels[4 * window.IndexOf(x, y) + 3] != 0;
  }
};

/// Person label of a pixel of the image: 0 off the person, else a label of clothes and skin, or 1 without labels.
using PersonAt = std::function<uint8_t(int x, int y)>;

/// Cuts the part of `image` around the person: the bounding box of its pixels in `search` (clipped to the image) and of
/// `body`, with a margin of `margin` pixels. Pixels outside `search` count as background. A frame without the person
/// has an empty window. The caller sets time, frame and camera.
TrainingView CutTrainingView(const Image& image, const PersonAt& person_at, const PixelBox& search,
                             const PixelBox& body, int margin);

/// Converts the view to the ground truth of ImageLoss. Reuses the memory of `truth`.
void FillTruth(const TrainingView& view, ImageTruth* truth);

}  // namespace bodyloom
