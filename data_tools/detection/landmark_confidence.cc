// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/landmark_confidence.h"

#include <algorithm>

namespace bodyloom {

double LandmarkConfidence(const PoseLandmark& landmark) {
  return landmark.pixel.allFinite() ? std::clamp(landmark.visibility, 0.0, 1.0) : 0;
}

}  // namespace bodyloom
