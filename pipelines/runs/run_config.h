// SPDX-License-Identifier: Apache-2.0
/// Reads and writes config.json of the renderers' run folders.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "neural/guided/guided_config.h"
#include "neural/photo/photo_config.h"

namespace bodyloom {

std::string RunConfigPath(const std::string& run_dir);

/// Reads RUN/config.json of a run of `program`. Throws std::runtime_error naming the file if it is missing, not JSON,
/// or of another program.
nlohmann::json ReadRunConfig(const std::string& run_dir, const std::string& program);

// Run of the pose-guided renderer: everything needed to use its checkpoint.

struct GuidedRun {
  GuidedConfig config;
  int reach = 0;      ///< pixels that clothes reach beyond the body (neural/motion/motion_frame.h), 0: not known
  std::string notes;  ///< JSON object of what else is known: data, options
};

std::string GuidedRunJson(const GuidedRun& run);

/// Of RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
GuidedRun ReadGuidedRun(const std::string& run_dir);

// Run of the one-photo renderer: everything needed to use its checkpoint.

struct PhotoRun {
  PhotoConfig config;
  int reach = 0;      ///< pixels that clothes reach beyond the body (neural/photo/photo_window.h)
  std::string notes;  ///< JSON object of what else is known: data, options
};

std::string PhotoRunJson(const PhotoRun& run);

/// Of RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
PhotoRun ReadPhotoRun(const std::string& run_dir);

}  // namespace bodyloom
