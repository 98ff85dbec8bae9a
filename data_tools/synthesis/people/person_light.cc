// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/person_light.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "geometry/base/hash_random.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Directions about the vertical.
class AroundPerson {
 public:
  explicit AroundPerson(const Vector3d& up)
      : up_(up), side_(up.cross(Vector3d::UnitZ()).normalized()), away_(side_.cross(up)) {}

  /// Azimuth 0: from behind the person, π: from behind the camera.
  [[nodiscard]] Vector3f At(double azimuth, double height) const {
    const Vector3d level = std::cos(azimuth) * away_ + std::sin(azimuth) * side_;
    return (std::cos(height) * level + std::sin(height) * up_).cast<float>().normalized();
  }

 private:
  Vector3d up_, side_, away_;
};

PersonLight StudioLight(const AroundPerson& around, HashRandom* random) {
  PersonLight light;
  const double beside = random->Uniform(0.3, 1.1);
  const double key = random->Uniform() < 0.5 ? -beside : beside;
  const double key_height = random->Uniform(0.4, 0.9), fill_height = random->Uniform(0.0, 0.5);
  light.towards = {around.At(key, key_height), around.At(-1.5 * key, fill_height)};
  light.ambient = float(random->Uniform(0.5, 0.62));
  const auto key_strength = float(random->Uniform(0.5, 0.65)), fill_strength = float(random->Uniform(0.1, 0.25));
  light.strength = {key_strength, fill_strength};
  return light;
}

PersonLight NaturalLight(const AroundPerson& around, HashRandom* random) {
  PersonLight light;
  const double hardness = random->Uniform();  // 0: an overcast sky, 1: the sun
  constexpr double kBehindCamera = std::numbers::pi, kMaxBeside = 2.4;
  const double key = kBehindCamera + random->Uniform(-kMaxBeside, kMaxBeside),
               fill = random->Uniform(0, 2 * std::numbers::pi);
  const double key_height = random->Uniform(0.15, 1.35), fill_height = random->Uniform(-0.2, 0.8);
  light.towards = {around.At(key, key_height), around.At(fill, fill_height)};
  light.ambient = float(0.85 - 0.5 * hardness + random->Uniform(-0.08, 0.08));
  const auto key_strength = float(0.2 + 0.7 * hardness + random->Uniform(-0.05, 0.1)),
             fill_strength = float(random->Uniform(0.02, 0.25));
  light.strength = {key_strength, fill_strength};
  light.shadow_softness_m = float(0.06 - 0.055 * hardness);
  return light;
}

}  // namespace

std::string ToString(LightStyle style) { return style == LightStyle::kNatural ? "natural" : "studio"; }

LightStyle LightStyleFromString(const std::string& name) {
  for (const LightStyle style : {LightStyle::kStudio, LightStyle::kNatural}) {
    if (ToString(style) == name) return style;
  }
  throw std::invalid_argument("light style \"" + name + "\", expected studio or natural");
}

PersonLight LightOfSeed(const Vector3d& up_in_camera, LightStyle style, uint64_t seed) {
  HashRandom random(seed, {0x6c696768});
  const AroundPerson around(up_in_camera);
  return style == LightStyle::kNatural ? NaturalLight(around, &random) : StudioLight(around, &random);
}

}  // namespace bodyloom
