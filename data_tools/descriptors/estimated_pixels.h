// SPDX-License-Identifier: Apache-2.0
/// What the pixels of a clip show of the body by estimates from its pictures, DensePose's IUV images, in place of the
/// tracked body's own (PersonFrames::BodyMaps).
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
  static constexpr double kMaxGap = 0.05;  ///< chart units: a label farther outside its chart shows nothing

  /// Frame t's is the folder's picture `first` + t in the order of their numbers: of those whose names end in _IUV
  /// where there are any. `path` may also be one picture, of a clip of one frame. Keeps a reference to the body. Throws
  /// std::runtime_error naming the path when it has too few for `num_frames`, std::invalid_argument when the body has
  /// no charts or no atlas.
  EstimatedPixels(const BodyModel& body, const std::string& path, int num_frames, int first = 0);

  /// Frame t's window: atlas coordinates (2 × height × width, 0 elsewhere) and a mask (height × width), each pixel that
  /// of the nearest pixel of the picture; `parts` (height × width, or empty), 0 elsewhere. May be called by several
  /// threads. Throws std::runtime_error naming a picture that is no IUV image or not of the size that the window was
  /// planned for.
  void BodyMaps(const PersonWindow& window, int t, std::span<float> uv, std::span<float> mask,
                std::span<uint8_t> parts = {}) const;

 private:
  const BodyModel& body_;
  ChartLookup charts_;
  std::vector<std::string> files_;  ///< by frame
};

}  // namespace bodyloom
