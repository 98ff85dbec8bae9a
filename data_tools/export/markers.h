// SPDX-License-Identifier: Apache-2.0
/// Marker trajectories of a person for biomechanics programs: HALPE_26's names in the order of Pose2Sim (a traversal of
/// its skeleton: Hip, RHip, RKnee … LWrist; without eyes and ears).
///
/// Shoulders, elbows, wrists, hips, knees, ankles, toes, heels and nose are the body's landmarks of these names (its
/// COCO-17, toes and heels). Hip: middle of the hips; Neck: middle of the shoulders; Head: the highest vertex of the
/// T-pose.
/// Source: Pose2Sim skeletons.py (HALPE_26).
#pragma once

#include <string>
#include <vector>

#include "data_tools/export/export_scene.h"

namespace bodyloom {

struct MarkerTrajectories {
  std::vector<std::string> names;
  std::vector<MatrixX3d> positions;  ///< T of M×3, metres, world (y up); NaN where the person is lost
  std::vector<double> seconds;       ///< T, evenly spaced from 0
  double fps = 30;
};

const std::vector<std::string>& HalpeMarkerNames();

/// Samples a person of a scene at every 1/fps from the scene's start: the markers of the frame within half a step, NaN
/// if there is none. Throws std::invalid_argument for a body without toes and heels.
MarkerTrajectories HalpeMarkers(const ExportScene& scene, const ExportPerson& person);

// Writes markers as a TRC file in the form of OpenSim and Pose2Sim: tab-separated text, metres, y up, one person per
// file, data from line 6 on; the three fields of an unknown marker are empty. Seven decimals. Source: Pose2Sim
// triangulation.py (make_trc), opensim-core TRCFileAdapter.cpp.

/// `name` is written to the first line. Throws std::invalid_argument when positions, names and seconds differ in
/// number.
std::string TrcText(const std::string& name, const MarkerTrajectories& markers);
void WriteTrc(const std::string& path, const MarkerTrajectories& markers);

// Writes markers as a C3D file: little-endian, points in float, millimetres, y up (X_SCREEN "+Z", Y_SCREEN "+Y"), no
// analog channels. Unknown markers have the residual −1. Groups POINT, ANALOG, FORCE_PLATFORM and TRIAL. Source:
// c3d.org user guide; ezc3d's reader.

/// Throws std::invalid_argument when positions and names differ in number, and for more than 255 markers or 65,535
/// frames, which this form of the header cannot hold.
std::string C3dBytes(const MarkerTrajectories& markers);
void WriteC3d(const std::string& path, const MarkerTrajectories& markers);

}  // namespace bodyloom
