// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_material.h"

#include <algorithm>
#include <stdexcept>

namespace bodyloom {

std::string ToString(ClothStuff stuff) {
  if (stuff == ClothStuff::kSilk) return "silk";
  return stuff == ClothStuff::kDenim ? "denim" : "cotton";
}

ClothStuff ClothStuffFromString(const std::string& name) {
  for (const ClothStuff stuff : {ClothStuff::kCotton, ClothStuff::kSilk, ClothStuff::kDenim}) {
    if (name == ToString(stuff)) return stuff;
  }
  throw std::invalid_argument("stuff '" + name + "', expected cotton, silk or denim");
}

LooseGarmentOptions SewnOf(ClothStuff stuff, LooseGarmentOptions cut) {
  constexpr double kFine_m = 0.018;
  switch (stuff) {
    case ClothStuff::kCotton:
      break;
    case ClothStuff::kSilk:
      cut.mass_kg_m2 = 0.07, cut.shear_compliance = 0.5, cut.bend_compliance = 80;
      cut.spacing_m = std::min(cut.spacing_m, kFine_m);
      break;
    case ClothStuff::kDenim:
      cut.mass_kg_m2 = 0.42, cut.shear_compliance = 0.02, cut.bend_compliance = 0.8;
      break;
  }
  return cut;
}

ClothOptions MovedAs(ClothStuff stuff, ClothOptions options) {
  switch (stuff) {
    case ClothStuff::kCotton:
      break;
    case ClothStuff::kSilk:
      options.friction = 0.2, options.damping = 0.4;
      break;
    case ClothStuff::kDenim:
      options.friction = 0.45, options.damping = 1.2;
      break;
  }
  return options;
}

}  // namespace bodyloom
