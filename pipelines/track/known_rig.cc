// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/known_rig.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr std::array<const char*, 3> kKnownOfRigNames = {"intrinsics", "poses", "clocks"};

std::string NameOfFile(const std::string& path) {
  const std::filesystem::path file = std::filesystem::path(path).lexically_normal();
  return file.has_filename() ? file.stem().string() : file.parent_path().filename().string();
}

/// Index of each view's camera in the file: that of its name, where every view has one; else in their order.
std::vector<size_t> CamerasByView(const KnownRigRequest& request, const std::vector<std::string>& names,
                                  const std::vector<NamedCamera>& cameras) {
  std::vector<size_t> index;
  try {
    for (const std::string& name : names) {
      index.push_back(static_cast<size_t>(&FindCamera(cameras, name, request.cameras) - cameras.data()));
    }
  } catch (const std::runtime_error& error) {
    if (request.names_given) throw;
    if (cameras.size() != names.size()) {
      throw std::runtime_error(Concatenate(error.what(), "; expected cameras of these names or ", names.size(),
                                           " cameras in the order of the views"));
    }
    index.clear();
    for (size_t v = 0; v < names.size(); ++v) index.push_back(v);
  }
  if (std::set<size_t>(index.begin(), index.end()).size() != index.size()) {
    throw std::runtime_error(request.cameras + ": two views have the same camera, expected one each");
  }
  return index;
}

void CheckCamera(const KnownRigRequest& request, const NamedCamera& camera) {
  if (request.image_width > 0 &&
      (camera.camera.width != request.image_width || camera.camera.height != request.image_height)) {
    throw std::runtime_error(Concatenate(request.cameras, ": camera ", PrintableText(camera.name), " is for images of ",
                                         camera.camera.width, "x", camera.camera.height, ", --image-size says ",
                                         request.image_width, "x", request.image_height));
  }
  if (camera.camera.model != CameraModel::kPinhole) {
    throw std::runtime_error(request.cameras + ": camera " + PrintableText(camera.name) +
                             " is of weak perspective, several views need pinhole cameras");
  }
}

}  // namespace

std::string ToString(KnownOfRig known) { return kKnownOfRigNames[static_cast<size_t>(known)]; }

KnownOfRig KnownOfRigFromString(const std::string& word) {
  const auto found = std::find(kKnownOfRigNames.begin(), kKnownOfRigNames.end(), word);
  BODYLOOM_CHECK(found != kKnownOfRigNames.end(), "'", word, "', expected intrinsics, poses or clocks");
  return static_cast<KnownOfRig>(found - kKnownOfRigNames.begin());
}

std::vector<std::string> NamesOfViews(const std::vector<std::string>& given, const std::vector<std::string>& files) {
  if (!given.empty()) return given;
  std::vector<std::string> names;
  for (const std::string& file : files) names.push_back(NameOfFile(file));
  if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) return names;
  for (size_t v = 0; v < names.size(); ++v) names[v] = "view" + std::to_string(v + 1);
  return names;
}

KnownRig::KnownRig(const KnownRigRequest& request, const std::vector<std::string>& names) {
  if (request.cameras.empty()) return;
  const std::vector<NamedCamera> cameras = LoadCameras(request.cameras, request.detections);
  const std::vector<RigCamera> rig = IsRigFile(request.cameras) ? ReadRig(request.cameras) : std::vector<RigCamera>();
  for (const size_t i : CamerasByView(request, names, cameras)) {
    CheckCamera(request, cameras[i]);
    cameras_.push_back(cameras[i]);
    if (request.known == KnownOfRig::kClocks && !rig.empty()) clocks_.push_back(rig[i]);
  }
  const auto posed =
      std::count_if(cameras_.begin(), cameras_.end(), [](const auto& camera) { return camera.has_pose; });
  if (request.known == KnownOfRig::kIntrinsics || posed == 0) return;
  if (posed != static_cast<ptrdiff_t>(cameras_.size())) {
    throw std::runtime_error(Concatenate(request.cameras, ": ", posed, " of the ", cameras_.size(),
                                         " views' cameras have a pose, expected all of them, or --known intrinsics"));
  }
  has_poses_ = true;
}

std::optional<CameraPose> KnownRig::PoseOf(size_t view) const {
  return has_poses_ ? std::optional<CameraPose>(cameras_[view].pose) : std::nullopt;
}

RigCamera KnownRig::ClockOf(size_t view, double middle_s) const {
  RigCamera clock;
  clock.middle_s = middle_s;
  if (clocks_.empty() || !clocks_[0].HasClock() || !clocks_[view].HasClock()) {
    clock.offset_s = std::numeric_limits<double>::quiet_NaN();
    return clock;
  }
  // Both are relative to a third.
  clock.rate = (1 + clocks_[view].rate) / (1 + clocks_[0].rate) - 1;
  clock.offset_s = clocks_[view].TimeAt(clocks_[0].FirstTimeAt(middle_s)) - middle_s;
  return clock;
}

}  // namespace bodyloom
