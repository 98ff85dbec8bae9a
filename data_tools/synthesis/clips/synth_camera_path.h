// SPDX-License-Identifier: Apache-2.0
/// Paths of moving cameras for synthetic clips.
///
/// kHandHeld  at the position of PlaceSynthCamera(), with shake: rotations about its three axes and translations along
///            them are smooth drifts (smooth_curve.h) of shake_deg and shake_m, with a time constant of 0.6 s
/// kWalking   follows the person: as kHandHeld about a position that follows the person's pelvis over the ground,
///            averaged over a second
/// kOrbit     circles the person by orbit_deg over the clip, about the vertical through the pelvis, which it follows
///            likewise; a smooth start and end, and the same shake
/// For kWalking and kOrbit the camera is placed as if the person stayed in place, so its distance does not depend on
/// the person's path.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data_tools/synthesis/clips/synth_camera.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"

namespace bodyloom {

enum class SynthCameraMotion {
  kStill,
  kHandHeld,
  kWalking,
  kOrbit,
};
/// "still", "hand-held", "walking", "orbit".
std::string ToString(SynthCameraMotion motion);
/// Parses these texts; throws std::invalid_argument for others.
SynthCameraMotion SynthCameraMotionFromString(const std::string& text);

struct SynthCameraPathOptions {
  SynthCameraMotion motion = SynthCameraMotion::kStill;
  double shake_deg = 1.5, shake_m = 0.08;  ///< standard deviations, of each axis
  double orbit_deg = 90;
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct SynthCameraPath {
  SynthCamera first;                          ///< the camera of frame 0, whose frame is the scene
  std::vector<CameraPose> camera_from_scene;  ///< of every frame; empty for kStill
};

/// Throws std::invalid_argument when options are out of range, no frame is finite, or the camera is a moving one of
/// weak perspective. Deterministic for a seed.
SynthCameraPath MakeSynthCameraPath(const BodyModel& body, const Motion& motion, const SynthCameraOptions& camera,
                                    const SynthCameraPathOptions& path, uint64_t seed);

}  // namespace bodyloom
