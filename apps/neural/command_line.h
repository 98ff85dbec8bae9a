// SPDX-License-Identifier: Apache-2.0
/// The command that does a job again, for the files that remember it.
#pragma once

#include <string>

#include "pipelines/neural/motion/animate_motion.h"

namespace bodyloom {

/// "bodyloom animate motion --run run …": what the result depends on, what was left at its default left out.
std::string CommandLine(const AnimateMotionRequest& request);

}  // namespace bodyloom
