// SPDX-License-Identifier: Apache-2.0
/// Writes joint angles for spreadsheets and for OpenSim, and the events of gait as JSON.
#pragma once

#include <string>

#include "geometry/biomechanics/gait.h"
#include "geometry/biomechanics/track_angles.h"

namespace bodyloom {

/// A line of names, then one line a frame: frame (from 0), time (the track's, seconds), the coordinates (degrees with
/// four decimals, metres with six), and, where there is one in some frame, NAME_sigma for each coordinate that has a
/// standard deviation (degrees). Fields of a lost frame, and unknown standard deviations, are empty. Throws
/// std::invalid_argument when the sizes disagree.
std::string AnglesCsv(const TrackAngles& angles);

/// A motion file of OpenSim: its header (Coordinates, version=1, nRows, nColumns, inDegrees=yes, two lines of text,
/// endheader), names and rows separated by tabs, eight decimals; time is the track's. Lost frames have no row. The
/// angles must be those of PelvisOrder::kTiltFirst. Throws std::invalid_argument when the sizes disagree, or every
/// frame is lost.
/// Source: the files that OpenSim's inverse kinematics writes.
std::string AnglesMot(const TrackAngles& angles);

/// One JSON object: walks, reason (where nobody walks), num_steps, cadence_per_min, step_time_s, step_length_m {left,
/// right}, speed_mps (null where nobody walks), bouts_s [[first, last]], events [{time_s, frame, foot: "left" or
/// "right", event: "foot_strike" or "foot_off"}]. Ends with a newline.
std::string GaitJson(const GaitReport& gait);

}  // namespace bodyloom
