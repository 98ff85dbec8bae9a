// SPDX-License-Identifier: Apache-2.0
/// Sends a body's pose over UDP by the Virtual Motion Capture protocol (OSC), which programs for avatars read, and
/// Blender, Unity and Unreal with their add-ons.
///
/// For each frame, in bundles of at most 1,200 bytes:
///   /VMC/Ext/OK        loaded 1, calibration state 3, calibration mode 0, tracking 1 (the person is seen) or 0
///   /VMC/Ext/T         seconds
///   /VMC/Ext/Root/Pos  "root" at the origin, not turned
///   /VMC/Ext/Bone/Pos  name, position x y z, rotation x y z w: each of VmcBones()
/// Without a pose only the first two. Nothing is waited for: whether somebody receives it stays unknown.
/// Source: VMC protocol specification (protocol.vmc.info), performer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data_tools/export/vmc_bones.h"

namespace bodyloom {

class VmcSender {
 public:
  /// `address`: HOST:PORT, port 1 to 65535. Throws std::invalid_argument for another form, std::runtime_error naming a
  /// host that is not known.
  explicit VmcSender(const std::string& address);
  ~VmcSender();
  VmcSender(const VmcSender&) = delete;
  VmcSender& operator=(const VmcSender&) = delete;

  /// `bones`: empty when there is no pose.
  void Send(double seconds, bool tracked, const std::vector<VmcBone>& bones);

 private:
  class Target;
  std::unique_ptr<Target> target_;
};

}  // namespace bodyloom
