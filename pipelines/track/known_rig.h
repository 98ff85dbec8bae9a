// SPDX-License-Identifier: Apache-2.0
/// Knowledge of several views that a file of cameras gives.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data_tools/observations/load_cameras.h"
#include "geometry/scene/rig.h"

namespace bodyloom {

/// Use that is made of the file of cameras; what is left out is estimated.
enum class KnownOfRig {
  kIntrinsics,
  kPoses,  ///< and poses, if the file has them
  kClocks  ///< and clocks, if it is a rig's (data_tools/observations/rig_io.h)
};
/// "intrinsics", "poses" or "clocks".
std::string ToString(KnownOfRig known);
/// The other way; throws std::invalid_argument for another word.
KnownOfRig KnownOfRigFromString(const std::string& word);

/// Names of views: those given, else the stems of their files, "cam_01" of "data/cam_01.json" and "data/cam_01/", or
/// "view1", "view2" … where two files have the same.
std::vector<std::string> NamesOfViews(const std::vector<std::string>& given, const std::vector<std::string>& files);

struct KnownRigRequest {
  std::string cameras;       ///< the file; empty: nothing is known
  std::string detections;    ///< of the first view, which may identify its camera in a folder of them
  bool names_given = false;  ///< every view must have a camera of its name; else they may be in the views' order
  KnownOfRig known = KnownOfRig::kClocks;
  int image_width = 0, image_height = 0;  ///< of all views; 0: as the file says
};

class KnownRig {
 public:
  /// Throws std::runtime_error naming file and place, also where a view has no camera, where two have the same, where
  /// some have poses and some have none, and for weak perspective.
  KnownRig(const KnownRigRequest& request, const std::vector<std::string>& names);

  /// Null where nothing is known.
  [[nodiscard]] const NamedCamera* CameraOf(size_t view) const { return cameras_.empty() ? nullptr : &cameras_[view]; }
  /// Of all views, or of none.
  [[nodiscard]] std::optional<CameraPose> PoseOf(size_t view) const;
  /// Clock relative to that of the first view about `middle_s` of the latter; without camera and pose, its offset NaN
  /// where it is not known.
  [[nodiscard]] RigCamera ClockOf(size_t view, double middle_s) const;

 private:
  std::vector<NamedCamera> cameras_;  ///< of each view, or empty
  std::vector<RigCamera> clocks_;     ///< likewise
  bool has_poses_ = false;
};

}  // namespace bodyloom
