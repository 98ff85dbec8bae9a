// SPDX-License-Identifier: Apache-2.0
#include "geometry/uv_maps/descriptor_options.h"

#include <algorithm>

#include "geometry/base/check.h"

namespace bodyloom {

bool DescriptorOptions::IsValid(std::string* why) const {
  if (!texels.IsValid(why) || !SurfaceMotion::IsValid(why)) return false;
  const auto no = [why](const std::string& text) {
    *why = text;
    return false;
  };
  if (past < 0 || past > 1000) return no(Concatenate("past is ", past, ", expected 0..1000"));
  if (past == 0 && !normals) return no("neither normals nor velocities requested");
  if (num_threads < 1 || num_threads > 1024)
    return no(Concatenate("num_threads is ", num_threads, ", expected 1..1024"));
  return true;
}

namespace {

const std::vector<VelocityScheme>& Schemes() {
  static const std::vector<VelocityScheme> schemes = {VelocityScheme::kBackward, VelocityScheme::kCentral,
                                                      VelocityScheme::kSavitzkyGolay};
  return schemes;
}

size_t IndexIn(const std::vector<std::string>& names, const std::string& name, const char* what) {
  const auto found = std::find(names.begin(), names.end(), name);
  std::string all;
  for (const std::string& one : names) all += (all.empty() ? "" : ", ") + one;
  BODYLOOM_CHECK(found != names.end(), what, " \"", name, "\", expected one of ", all);
  return static_cast<size_t>(found - names.begin());
}

}  // namespace

const std::vector<std::string>& VelocityNames() {
  static const std::vector<std::string> names = {"backward", "central", "savgol", "analytic"};
  return names;
}

std::string VelocityName(const SurfaceMotion& motion) {
  if (motion.analytic) return VelocityNames().back();
  const std::vector<VelocityScheme>& schemes = Schemes();
  return VelocityNames()[std::find(schemes.begin(), schemes.end(), motion.velocity.scheme) - schemes.begin()];
}

void SetVelocity(const std::string& name, SurfaceMotion* motion) {
  const size_t index = IndexIn(VelocityNames(), name, "velocity");
  motion->analytic = index == Schemes().size();
  // The joints' rates are fitted as savgol.
  motion->velocity.scheme = motion->analytic ? VelocityScheme::kSavitzkyGolay : Schemes()[index];
}

const std::vector<std::string>& SurfaceFrameNames() {
  static const std::vector<std::string> names = {ToString(SurfaceFrame::kCamera), ToString(SurfaceFrame::kWorld),
                                                 ToString(SurfaceFrame::kBody)};
  return names;
}

SurfaceFrame SurfaceFrameNamed(const std::string& name) {
  return static_cast<SurfaceFrame>(IndexIn(SurfaceFrameNames(), name, "frame"));
}

CameraPose LevelCamera() {
  CameraPose pose;
  pose.camera_from_world_rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return pose;
}

}  // namespace bodyloom
