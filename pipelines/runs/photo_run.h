// SPDX-License-Identifier: Apache-2.0
/// config.json of a run of the one-photo renderer: what it takes to use its checkpoint.
#pragma once

#include <string>

#include "bodyloom/neural/photo/photo_config.h"

namespace bodyloom {

struct PhotoRun {
  PhotoConfig config;
  int reach = 0;      ///< pixels that clothes reach beyond the body (neural/photo/photo_window.h)
  std::string notes;  ///< JSON object of what else is known: data, options
};

std::string PhotoRunJson(const PhotoRun& run);

/// Of RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
PhotoRun ReadPhotoRun(const std::string& run_dir);

}  // namespace bodyloom
