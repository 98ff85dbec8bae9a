// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/photo/photo_backdrop.h"

#include "bodyloom/data_tools/datasets/photo_segmentation.h"

namespace bodyloom {

PhotoBackdrop::PhotoBackdrop(const PhotoBackground& background, const Photo& photo, PictureSize size) {
  if (background.own) {
    filled_ = Covering(FilledBackground(photo.picture, photo.person), size.width, size.height);
  } else {
    background_.emplace(background.path, size.width, size.height);
  }
}

}  // namespace bodyloom
