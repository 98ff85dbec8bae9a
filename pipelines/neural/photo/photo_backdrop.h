// SPDX-License-Identifier: Apache-2.0
/// The background of a person rendered from a photo, frame by frame.
#pragma once

#include <optional>

#include "bodyloom/pipelines/neural/photo/photo_input.h"
#include "bodyloom/pipelines/people/background.h"
#include "bodyloom/pipelines/people/composite.h"

namespace bodyloom {

class PhotoBackdrop {
 public:
  /// Pictures of this size. Throws std::runtime_error naming the background that cannot be read.
  PhotoBackdrop(const PhotoBackground& background, const Photo& photo, PictureSize size);
  /// The next frame.
  const Image& Next() { return background_ ? background_->Next() : filled_; }

 private:
  std::optional<Background> background_;
  Image filled_;  ///< without `background_`: the photo's own, filled in where the person stood
};

}  // namespace bodyloom
