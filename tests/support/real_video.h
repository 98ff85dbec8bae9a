// SPDX-License-Identifier: Apache-2.0
/// What tests of the pose detector on real video need, and may lack.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "tracking/detection/model_files.h"

namespace bodyloom {

/// Why people cannot be detected in this recording here: it or the networks (./dev models) are not there. Empty when
/// they can.
inline std::string WhyNoDetection(const std::string& recording) {
  if (!std::filesystem::exists(recording)) return recording + " is not there";
  try {
    FindModelFile(kPoseDetectorFile);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace bodyloom
