// SPDX-License-Identifier: Apache-2.0
/// A short training run of the one-photo renderer on toy people.
#pragma once

#include <string>

#include "neural/photo/train_photo.h"
#include "tests/neural/photo/toy_photos.h"
#include "tests/support/test_files.h"

namespace bodyloom {

inline TrainPhotoOptions ToyOptions(const std::string& folder, const PhotoConfig& config) {
  TrainPhotoOptions options;
  options.config = config;
  options.train = {0, 1};
  options.validation = {2};
  options.batch = 2;
  options.steps = 6;
  options.reach = 2;
  options.num_threads = 1;
  options.report_every = options.checkpoint_every = options.validate_every = 3;
  options.run_dir = EmptyFolder(folder);
  return options;
}

inline TrainPhotoOptions ToyOptions(const std::string& folder, PhotoVariant variant = PhotoVariant::kFull) {
  return ToyOptions(folder, ToyPhotoConfig(variant));
}

}  // namespace bodyloom
