// SPDX-License-Identifier: Apache-2.0
/// Exports calibrated cameras, such as the rig.json of a track from several views, to formats of other programs.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Output format (data_tools/export/camera_writers.h), in the frame of the cameras' poses.
enum class RigForm {
  kToml,    ///< Pose2Sim's Calib.toml
  kOpenCv,  ///< YAML of cv::FileStorage
  kColmap,  ///< a folder with a COLMAP text model
};
/// "rig-toml", "rig-opencv", "rig-colmap", in the order of RigForm.
const std::vector<std::string>& RigFormNames();
/// Throws std::invalid_argument for other names.
RigForm RigFormFromString(const std::string& name);

struct ExportRigRequest {
  std::string cameras;  ///< any file of cameras (data_tools/observations/load_cameras.h)
  RigForm form = RigForm::kToml;
  std::string out;  ///< file, or folder (kColmap)
};

struct ExportRigReport {
  std::vector<std::string> cameras;  ///< names
  std::string out;
};

/// Lines ending in a newline.
std::string ToText(const ExportRigReport& report);

/// Throws RequestError for missing fields and a file both read and written, std::runtime_error naming a file that
/// cannot be used, or cameras that lack a name or pose or have no place in the form.
ExportRigReport ExportRig(const ExportRigRequest& request);

}  // namespace bodyloom
