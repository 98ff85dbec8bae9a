// SPDX-License-Identifier: Apache-2.0
/// Cloth materials: mass, stiffness, friction and damping.
///
/// Mass and friction are typical of such cloth; compliances are of this simulation's links (loose_garment.h), chosen so
/// that the hem of a skirt has many folds (silk), some (cotton) or few (denim).
#pragma once

#include <string>

#include "geometry/cloth/cloth_simulation.h"
#include "geometry/cloth/loose_garment.h"

namespace bodyloom {

/// kCotton is the default of LooseGarmentOptions and ClothOptions.
enum class ClothMaterial { kCotton, kSilk, kDenim };

std::string ToString(ClothMaterial material);
/// Parses "cotton", "silk" or "denim"; throws std::invalid_argument for other names.
ClothMaterial ClothMaterialFromString(const std::string& name);

/// The cut with that material's mass and compliances, and a mesh fine enough for its folds (silk: 1.8 cm).
LooseGarmentOptions GarmentOptionsFor(ClothMaterial material, LooseGarmentOptions cut);

/// The simulation options with that material's friction and damping.
ClothOptions ClothOptionsFor(ClothMaterial material, ClothOptions options);

}  // namespace bodyloom
