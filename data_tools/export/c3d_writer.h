// SPDX-License-Identifier: Apache-2.0
/// Writes markers as a C3D file: little-endian, points in float, millimetres, y up (X_SCREEN "+Z", Y_SCREEN "+Y"), no
/// analog channels. Unknown markers have the residual −1. Groups POINT, ANALOG, FORCE_PLATFORM and TRIAL. Source:
/// c3d.org user guide; ezc3d's reader.
#pragma once

#include <string>

#include "data_tools/export/markers.h"

namespace bodyloom {

/// Throws std::invalid_argument when positions and names differ in number, and for more than 255 markers or 65,535
/// frames, which this form of the header cannot hold.
std::string C3dBytes(const MarkerTrajectories& markers);
void WriteC3d(const std::string& path, const MarkerTrajectories& markers);

}  // namespace bodyloom
