// SPDX-License-Identifier: Apache-2.0
/// A rendered clip as a single-person dataset, so that `bodyloom metrics` compares it with another, pixel by pixel.
#pragma once

#include <string>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/neural/motion/motion_picture.h"
#include "bodyloom/render/image.h"
#include "bodyloom/render/person_window.h"

namespace bodyloom {

/// The networks' prediction of frame t's window, as pictures as large as `composed` (which is taken as the frame's
/// image): the class of the window's nearest pixel, and normals between the four nearest, unit vectors where the class
/// is not background. `picture` without labels or normals: those are left empty.
PersonFrame SetFrameOf(const MotionPicture& picture, const PersonWindow& window, int t, const Image& composed);

/// Writes images, labels and normals (as far as the renderer makes them) and the track as a single-person dataset.
class RenderedDataset {
 public:
  /// Throws std::runtime_error when the folder cannot be written.
  RenderedDataset(const std::string& path, const Track& track, double fps, bool labels, bool normals,
                  const std::string& command);
  /// Labels and normals that `frame` lacks and the dataset has: all background.
  void Add(int t, PersonFrame frame);
  /// `picture` of no pixels: a frame without a fit.
  void Add(int t, const MotionPicture& picture, const PersonWindow& window, const Image& composed);
  /// Until then the folder is no set.
  void Finish() const;

 private:
  SinglePersonDatasetInfo info_;
  SinglePersonDatasetWriter writer_;
};

}  // namespace bodyloom
