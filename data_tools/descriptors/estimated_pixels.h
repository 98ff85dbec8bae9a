// SPDX-License-Identifier: Apache-2.0
/// Surface coordinates of a clip's pixels from estimates, DensePose's IUV images, as a replacement for those of the
/// tracked body (PersonFrames::BodyMaps).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "render/texture/chart_lookup.h"
#include "render/view/person_window.h"

namespace bodyloom {

class EstimatedPixels {
 public:
  static constexpr double kMaxGap = 0.05;  ///< chart units: a label farther outside its chart is ignored

  /// Frame t is image number `first` + t of the folder in the order of their numbers, counting only names that end in
  /// _IUV if there are any. `path` may also be an image, for a clip of one frame. Keeps a reference to the body. Throws
  /// std::runtime_error naming the path when it has too few for `num_frames`, std::invalid_argument when the body has
  /// no charts or no atlas.
  EstimatedPixels(const BodyModel& body, const std::string& path, int num_frames, int first = 0);

  /// Writes frame t's window: atlas coordinates (2 × height × width, 0 elsewhere) and a mask (height × width), sampled
  /// at the nearest pixel of the image; `parts` (height × width, or empty), 0 elsewhere. May be called by several
  /// threads. Throws std::runtime_error naming an image that is not an IUV image or does not have the size for which
  /// the window was planned.
  void BodyMaps(const PersonWindow& window, int t, std::span<float> uv, std::span<float> mask,
                std::span<uint8_t> parts = {}) const;

 private:
  const BodyModel& body_;
  ChartLookup charts_;
  std::vector<std::string> files_;  ///< by frame
};

}  // namespace bodyloom
