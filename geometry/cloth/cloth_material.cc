// SPDX-License-Identifier: Apache-2.0
#include "geometry/cloth/cloth_material.h"

#include <algorithm>
#include <stdexcept>

namespace bodyloom {

std::string ToString(ClothMaterial material) {
  if (material == ClothMaterial::kSilk) return "silk";
  return material == ClothMaterial::kDenim ? "denim" : "cotton";
}

ClothMaterial ClothMaterialFromString(const std::string& name) {
  for (const ClothMaterial material : {ClothMaterial::kCotton, ClothMaterial::kSilk, ClothMaterial::kDenim}) {
    if (name == ToString(material)) return material;
  }
  throw std::invalid_argument("material '" + name + "', expected cotton, silk or denim");
}

LooseGarmentOptions GarmentOptionsFor(ClothMaterial material, LooseGarmentOptions cut) {
  constexpr double kFine_m = 0.018;
  switch (material) {
    case ClothMaterial::kCotton:
      break;
    case ClothMaterial::kSilk:
      cut.mass_kg_m2 = 0.07, cut.shear_compliance = 0.5, cut.bend_compliance = 80;
      cut.spacing_m = std::min(cut.spacing_m, kFine_m);
      break;
    case ClothMaterial::kDenim:
      cut.mass_kg_m2 = 0.42, cut.shear_compliance = 0.02, cut.bend_compliance = 0.8;
      break;
  }
  return cut;
}

ClothOptions ClothOptionsFor(ClothMaterial material, ClothOptions options) {
  switch (material) {
    case ClothMaterial::kCotton:
      break;
    case ClothMaterial::kSilk:
      options.friction = 0.2, options.damping = 0.4;
      break;
    case ClothMaterial::kDenim:
      options.friction = 0.45, options.damping = 1.2;
      break;
  }
  return options;
}

}  // namespace bodyloom
