// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "geometry/body/normals.h"
#include "geometry/scene/camera.h"
#include "geometry/uv_maps/surface_velocity.h"
#include "geometry/uv_maps/uv_texels.h"
#include "geometry/uv_maps/velocity_stencil.h"

namespace bodyloom {

// Representation of the motion of a body's surface: the axes and the velocity scheme, with their names, as shared by
// descriptor files and the motion-dependent renderer.

struct SurfaceMotion {
  VelocityStencilOptions velocity;
  bool analytic = false;  ///< velocities by the body model's derivative instead of differences of vertices
  /// Frame of normals and velocities. kCamera: where the track has the path of a moving camera, the velocities are the
  /// body's own, in the camera's axes of each frame; a camera that moves without a path adds its own motion. kWorld:
  /// one pose for the clip. kBody: independent of the camera.
  SurfaceFrame frame = SurfaceFrame::kCamera;
  CameraPose camera_pose;  ///< for SurfaceFrame::kWorld
  /// False with the reason when a field is out of range.
  [[nodiscard]] bool IsValid(std::string* why) const { return velocity.IsValid(why); }
};

/// Names of the velocity schemes: the four that VelocityName() returns.
const std::vector<std::string>& VelocityNames();
/// "backward", "central", "savgol" or "analytic".
std::string VelocityName(const SurfaceMotion& motion);
/// Sets scheme and `analytic`. Throws std::invalid_argument for other names, listing these.
void SetVelocity(const std::string& name, SurfaceMotion* motion);

/// "camera", "world", "body" (ToString, geometry/uv_maps/surface_velocity.h).
const std::vector<std::string>& SurfaceFrameNames();
/// Throws std::invalid_argument for other names, listing these.
SurfaceFrame SurfaceFrameNamed(const std::string& name);

/// A level camera: the world's y is up and its z points at the camera.
CameraPose LevelCamera();

/// Options of the contents of a frame's descriptor.
struct DescriptorOptions : SurfaceMotion {
  UvTexelOptions texels;
  int past = 10;        ///< velocity maps per frame, its own included; 0 to 1000
  bool normals = true;  ///< the three channels of N
  NormalWeighting weighting = NormalWeighting::kArea;
  bool seen_only = false;  ///< texels that the frame's camera does not see are zero
  int num_threads = 1;     ///< 1 to 1024; the result does not depend on it
  /// False with the reason when a field is out of range.
  [[nodiscard]] bool IsValid(std::string* why) const;
  /// 3·normals + 3·past.
  [[nodiscard]] int channels() const { return 3 * (normals ? 1 : 0) + 3 * past; }
};

}  // namespace bodyloom
