// SPDX-License-Identifier: Apache-2.0
/// The config.json that every run folder of a renderer begins with.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "neural/guided/guided_config.h"
#include "neural/photo/photo_config.h"

namespace bodyloom {

std::string RunConfigPath(const std::string& run_dir);

/// RUN/config.json of a run of `program`. Throws std::runtime_error naming the file: not there, no JSON, or of another
/// program.
nlohmann::json ReadRunConfig(const std::string& run_dir, const std::string& program);

// config.json of a run of the pose-guided renderer: what it takes to use its checkpoint.

struct GuidedRun {
  GuidedConfig config;
  int reach = 0;      ///< pixels that clothes reach beyond the body (neural/motion/motion_frame.h), 0: not known
  std::string notes;  ///< JSON object of what else is known: data, options
};

std::string GuidedRunJson(const GuidedRun& run);

/// Of RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
GuidedRun ReadGuidedRun(const std::string& run_dir);

// config.json of a run of the one-photo renderer: what it takes to use its checkpoint.

struct PhotoRun {
  PhotoConfig config;
  int reach = 0;      ///< pixels that clothes reach beyond the body (neural/photo/photo_window.h)
  std::string notes;  ///< JSON object of what else is known: data, options
};

std::string PhotoRunJson(const PhotoRun& run);

/// Of RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
PhotoRun ReadPhotoRun(const std::string& run_dir);

}  // namespace bodyloom
