// SPDX-License-Identifier: Apache-2.0
#include "pipelines/export/export_rig.h"

#include <algorithm>
#include <stdexcept>

#include "data_tools/export/camera_writers.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "pipelines/files.h"

namespace bodyloom {
namespace {

void WriteRigAs(const ExportRigRequest& request, const std::vector<NamedCamera>& cameras) {
  switch (request.form) {
    case RigForm::kToml:
      return WriteFileAtomically(request.out, Pose2SimRigText(cameras));
    case RigForm::kOpenCv:
      return WriteFileAtomically(request.out, OpenCvRigText(cameras));
    case RigForm::kColmap:
      return WriteColmapRig(request.out, cameras);
  }
}

}  // namespace

const std::vector<std::string>& RigFormNames() {
  static const std::vector<std::string> names = {"rig-toml", "rig-opencv", "rig-colmap"};
  return names;
}

RigForm RigFormFromString(const std::string& name) {
  const std::vector<std::string>& names = RigFormNames();
  const auto found = std::find(names.begin(), names.end(), name);
  BODYLOOM_CHECK(found != names.end(), "'", name, "' is not a form of a rig");
  return static_cast<RigForm>(found - names.begin());
}

std::string ToText(const ExportRigReport& report) {
  return "cameras " + PrintableList(report.cameras) + "\nwrote " + report.out + "\n";
}

ExportRigReport ExportRig(const ExportRigRequest& request) {
  if (request.cameras.empty()) {
    throw RequestError("--what " + RigFormNames()[size_t(request.form)] + " writes cameras: give --cameras FILE");
  }
  RequireReadable(request.cameras, "cameras");
  RequireDistinct({request.cameras}, {request.out});
  const std::vector<NamedCamera> cameras = LoadCameras(request.cameras);
  ExportRigReport report;
  report.out = request.out;
  for (const NamedCamera& camera : cameras) {
    if (!camera.has_pose) {
      throw std::runtime_error(request.cameras + ": camera " + PrintableText(camera.name) +
                               " has no pose, expected 'rotation' and 'translation'");
    }
    report.cameras.push_back(camera.name);
  }
  if (request.form == RigForm::kColmap) {
    RequireWritableFolder(request.out);
  } else {
    RequireWritable(request.out);
  }
  try {
    WriteRigAs(request, cameras);
  } catch (const std::invalid_argument& error) {  // what the file holds has no place in the form
    throw std::runtime_error(request.cameras + ": " + error.what());
  }
  return report;
}

}  // namespace bodyloom
