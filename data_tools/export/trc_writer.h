// SPDX-License-Identifier: Apache-2.0
/// Markers as a TRC file, as OpenSim and Pose2Sim read and write it: tab-separated text, metres, y up, one person a file,
/// data from line 6 on; a marker that is not known leaves its three fields empty. Seven digits after the point.
/// Source: Pose2Sim triangulation.py (make_trc), opensim-core TRCFileAdapter.cpp.
#pragma once

#include <string>

#include "bodyloom/data_tools/export/markers.h"

namespace bodyloom {

/// `name` stands in the first line. Throws std::invalid_argument when positions, names and seconds differ in number.
std::string TrcText(const std::string& name, const MarkerTrajectories& markers);
void WriteTrc(const std::string& path, const MarkerTrajectories& markers);

}  // namespace bodyloom
