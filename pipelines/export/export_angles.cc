// SPDX-License-Identifier: Apache-2.0
#include "pipelines/export/export_angles.h"

#include "data_tools/export/angle_writers.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/biomechanics/track_angles.h"

namespace bodyloom {

std::string AnglesPathFault(const std::string& out) {
  const std::string extension = LowerExtension(out);
  if (extension == ".csv" || extension == ".mot") return "";
  return "angles are written to .csv or .mot (OpenSim), found " + out;
}

GaitReport ExportAngles(const BodyModel& body, const Track& track, const WorldFrame& world, const std::string& out,
                        const std::string& events) {
  const bool mot = LowerExtension(out) == ".mot";
  const TrackAngles angles =
      AnglesOfTrack(body, track, world, mot ? PelvisOrder::kTiltFirst : PelvisOrder::kRotationFirst);
  GaitReport gait = AnalyseGait(body, track, world);
  WriteFileAtomically(out, mot ? AnglesMot(angles) : AnglesCsv(angles));
  if (!events.empty()) WriteFileAtomically(events, GaitJson(gait));
  return gait;
}

}  // namespace bodyloom
