// SPDX-License-Identifier: Apache-2.0
/// A frame that a person of Gaussians is learned from.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/scene/camera.h"
#include "render/gaussian_avatar/avatar_frame.h"
#include "render/gaussian_avatar/learning/picture_loss.h"
#include "render/image/image.h"
#include "render/image/pixel_box.h"

namespace bodyloom {

struct TrainingView {
  int time = 0;  ///< which frame of the clip
  AvatarFrame frame;
  /// The last bones of the frame, K×12 each, as other runs of the garment's simulation have them; the run to learn from
  /// changes from one time that the view comes to the next.
  std::vector<std::vector<float>> other_cloth;
  Camera camera;                ///< without distortion
  PixelBox window;              ///< around the person, inside the picture
  std::vector<uint8_t> pixels;  ///< of the window, row-major: blue, green, red, PersonAt
  int person_pixels = 0;

  [[nodiscard]] bool ShowsPerson(int x, int y) const {
    return window.Contains(x, y) && pixels[4 * window.IndexOf(x, y) + 3] != 0;
  }
};

/// What of the person a pixel of the picture shows: 0 nothing, else a label of clothes and skin, 1 where there are
/// none.
using PersonAt = std::function<uint8_t(int x, int y)>;

/// The part of `picture` around the person: the smallest box that holds its pixels in `search` (clipped to the picture)
/// and `body`, with `margin` pixels around it. Pixels outside of `search` count as not the person's. A frame without
/// the person has an empty window. The caller sets time, frame and camera.
TrainingView CutTrainingView(const Image& picture, const PersonAt& person_at, const PixelBox& search,
                             const PixelBox& body, int margin);

/// The view as what a picture is compared with. Keeps the memory of `truth`.
void FillTruth(const TrainingView& view, PictureTruth* truth);

}  // namespace bodyloom
