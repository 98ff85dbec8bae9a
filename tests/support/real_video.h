// SPDX-License-Identifier: Apache-2.0
/// Requirements of the tests of the pose detector on real video.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "tracking/detection/model_files.h"

namespace bodyloom {

/// Reason why people cannot be detected in this recording: it or the networks (./dev models) are missing. Empty if they
/// can be.
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
