// SPDX-License-Identifier: Apache-2.0
/// How far a landmark of BlazePose may be trusted, as the confidence in [0, 1] that the tracker turns into a standard
/// deviation.
#pragma once

#include "bodyloom/data_tools/detection/pose_landmarks.h"

namespace bodyloom {

/// The landmark's visibility, within [0, 1]; 0 when a coordinate is not finite.
double LandmarkConfidence(const PoseLandmark& landmark);

}  // namespace bodyloom
