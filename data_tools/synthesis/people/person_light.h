// SPDX-License-Identifier: Apache-2.0
/// Lighting of a synthetic person.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace bodyloom {

/// Studio: even ambient light, and two lights from above and beside or behind the person, without shadows: rims are
/// bright, the rest shows mainly its colours. Natural: lights from any azimuth, more often from the camera's side, soft
/// or hard, with shadows and ambient occlusion.
enum class LightStyle { kStudio, kNatural };

std::string ToString(LightStyle style);
/// "studio" or "natural"; throws std::invalid_argument otherwise.
LightStyle LightStyleFromString(const std::string& name);

/// The colour of a surface with normal n is its colour, in image values, times
///   ambient · o + Σ strength · r · max(0, n·towards),
/// o: ambient openness (1 without shadows; render/shadows/shadow_map.h, a fifth of the occlusion compensated for light
/// reflected by the person), r: the share of the light that reaches the point (1 without shadows).
struct PersonLight {
  float ambient = 0.45F;
  std::array<Eigen::Vector3f, 2> towards = {Eigen::Vector3f::UnitY(),
                                            Eigen::Vector3f::UnitY()};  ///< unit, camera frame
  std::array<float, 2> strength = {0.6F, 0.2F};
  std::optional<float> shadow_softness_m;  ///< half the width of a shadow's edge; absent: there are no shadows
};

/// Returns the light of a seed; the first of the two is the stronger. `up_in_camera`: unit; light comes from above.
PersonLight LightOfSeed(const Eigen::Vector3d& up_in_camera, LightStyle style, uint64_t seed);

}  // namespace bodyloom
