// SPDX-License-Identifier: Apache-2.0
/// Pictures of a person of Gaussians as a single-person dataset, so that `bodyloom metrics` compares it with another.
#pragma once

#include <span>
#include <string>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/render/splat/splat_picture.h"

namespace bodyloom {

/// A pixel's label: kBottom where the garment (skirt, dress or coat) makes at least half of it, kSkin on the rest of
/// the person, whose clothes nobody told apart, kBackground where alpha is below ½. Index in all channels, width ×
/// height. `garment`: its share of the window's pixels; empty: none is worn.
Image LabelsOf(const SplatPicture& picture, std::span<const float> garment, int width, int height);

/// Images, labels and track. May not be used by two threads at once.
class AvatarDataset {
 public:
  /// Pictures are of the track's size. `fps`: 0 where the track does not say; it is kFpsWithoutTimes then. Throws
  /// std::runtime_error when the folder cannot be written.
  AvatarDataset(const std::string& path, const Track& track, double fps, const std::string& command);
  /// `image`: what is shown of frame t, background and all.
  void Add(int t, const Image& image, const SplatPicture& picture, std::span<const float> garment);
  /// A frame without a fit: background alone.
  void AddEmpty(int t, const Image& image);
  /// Until then the folder is no dataset.
  void Finish() const { writer_.Finish(); }

 private:
  SinglePersonDatasetWriter writer_;
};

}  // namespace bodyloom
