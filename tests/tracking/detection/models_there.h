// SPDX-License-Identifier: Apache-2.0
/// Tests of hands and faces are skipped where their networks are not (`./dev models`).
#pragma once

#include <stdexcept>

#include "tracking/detection/model_files.h"

namespace bodyloom {

inline bool HandModelsAreThere() {
  try {
    for (const char* file : {kHandRegionFile, kHandLandmarkFile, kFaceLandmarkFile}) FindModelFile(file);
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

}  // namespace bodyloom
