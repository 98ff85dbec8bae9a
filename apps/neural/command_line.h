// SPDX-License-Identifier: Apache-2.0
/// Command lines that repeat a job, stored in output files.
#pragma once

#include <string>

#include "pipelines/neural/motion/animate_motion.h"

namespace bodyloom {

/// "bodyloom animate motion --run run …": the options that affect the result, without those left at their defaults.
std::string CommandLine(const AnimateMotionRequest& request);

}  // namespace bodyloom
