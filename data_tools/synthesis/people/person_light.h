// SPDX-License-Identifier: Apache-2.0
/// The light that a synthetic person stands in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace bodyloom {

/// Studio: even from all around, and two lights from above and beside or behind the person, which cast no shadows: rims
/// are bright, the rest shows its colours and little else. Natural: from anywhere around, more often from the camera's
/// side, even or hard, with shadows, and darker where a place is not open to all around.
enum class LightStyle { kStudio, kNatural };

std::string ToString(LightStyle style);
/// "studio" or "natural"; throws std::invalid_argument otherwise.
LightStyle LightStyleFromString(const std::string& name);

/// A surface of normal n shows its colour, of the picture's own numbers, times
///   ambient · o + Σ strength · r · max(0, n·towards),
/// o: how open the place is (1 without shadows; render/shadows/shadow_map.h, of which a fifth is made up for by the
/// light that the person throws back), r: the share of the light that reaches it (1 without shadows).
struct PersonLight {
  float ambient = 0.45F;
  std::array<Eigen::Vector3f, 2> towards = {Eigen::Vector3f::UnitY(),
                                            Eigen::Vector3f::UnitY()};  ///< unit, camera frame
  std::array<float, 2> strength = {0.6F, 0.2F};
  std::optional<float> shadow_softness_m;  ///< half the width of a shadow's edge; absent: there are no shadows
};

/// The light of a seed, the first of the two the stronger. `up_in_camera`: unit; it comes from above.
PersonLight LightOfSeed(const Eigen::Vector3d& up_in_camera, LightStyle style, uint64_t seed);

}  // namespace bodyloom
