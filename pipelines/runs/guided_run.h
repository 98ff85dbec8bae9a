// SPDX-License-Identifier: Apache-2.0
/// config.json of a run of the pose-guided renderer: what it takes to use its checkpoint.
#pragma once

#include <string>

#include "bodyloom/neural/guided/guided_config.h"

namespace bodyloom {

struct GuidedRun {
  GuidedConfig config;
  int reach = 0;      ///< pixels that clothes reach beyond the body (neural/motion/clothes_reach.h), 0: not known
  std::string notes;  ///< JSON object of what else is known: data, options
};

std::string GuidedRunJson(const GuidedRun& run);

/// Of RUN/config.json. Throws std::runtime_error naming the file, the key and what was expected.
GuidedRun ReadGuidedRun(const std::string& run_dir);

}  // namespace bodyloom
