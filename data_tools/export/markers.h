// SPDX-License-Identifier: Apache-2.0
/// A person as markers over time, for biomechanics programs: HALPE_26's names in the order in which Pose2Sim writes
/// them (a walk through its skeleton: Hip, RHip, RKnee … LWrist; eyes and ears are not in it).
///
/// Shoulders, elbows, wrists, hips, knees, ankles, toes, heels and nose are the body's landmarks of these names (its
/// COCO-17, toes and heels). Hip: middle of the hips; Neck:
/// middle of the shoulders; Head: the highest vertex of the T-pose.
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

/// A person of a scene at every 1/fps from the scene's start; a frame within half a step gives its markers, without one
/// they are NaN. Throws std::invalid_argument for a body without toes and heels.
MarkerTrajectories HalpeMarkers(const ExportScene& scene, const ExportPerson& person);

// Markers as a TRC file, as OpenSim and Pose2Sim read and write it: tab-separated text, metres, y up, one person a
// file, data from line 6 on; a marker that is not known leaves its three fields empty. Seven digits after the point.
// Source: Pose2Sim triangulation.py (make_trc), opensim-core TRCFileAdapter.cpp.

/// `name` stands in the first line. Throws std::invalid_argument when positions, names and seconds differ in number.
std::string TrcText(const std::string& name, const MarkerTrajectories& markers);
void WriteTrc(const std::string& path, const MarkerTrajectories& markers);

}  // namespace bodyloom
