// SPDX-License-Identifier: Apache-2.0
/// What cloth is made of: how heavy and stiff it is, how it slides and swings.
///
/// Mass and grip are typical of such cloth; compliances are of this simulation's links (loose_garment.h), chosen so
/// that the hem of a skirt falls into many folds (silk), some (cotton) or few (denim).
#pragma once

#include <string>

#include "geometry/cloth/cloth_simulation.h"
#include "geometry/cloth/loose_garment.h"

namespace bodyloom {

/// Cotton is what LooseGarmentOptions and ClothOptions are without being told.
enum class ClothStuff { kCotton, kSilk, kDenim };

std::string ToString(ClothStuff stuff);
/// Throws std::invalid_argument for what is neither "cotton", "silk" nor "denim".
ClothStuff ClothStuffFromString(const std::string& name);

/// The cut, sewn of that stuff: mass, compliances, and a mesh fine enough for its folds (silk: 1.8 cm).
LooseGarmentOptions SewnOf(ClothStuff stuff, LooseGarmentOptions cut);

/// The simulation with that stuff's friction and damping.
ClothOptions MovedAs(ClothStuff stuff, ClothOptions options);

}  // namespace bodyloom
