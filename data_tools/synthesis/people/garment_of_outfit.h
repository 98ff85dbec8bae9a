// SPDX-License-Identifier: Apache-2.0
/// How the loose garment of a synthetic person's outfit is cut.
#pragma once

#include <cstdint>

#include "bodyloom/data_tools/synthesis/people/outfit.h"
#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/cloth/loose_garment.h"

namespace bodyloom {

/// The garment of an outfit's kind and seed on a body with these joints (J×3, T-pose, SMPL's tree) and pinned ring
/// height scaled along; for a suit, which has none, length_m is 0.
LooseGarmentOptions LooseGarmentOf(const Outfit& outfit, const MatrixX3d& rest_joints, uint64_t seed);

}  // namespace bodyloom
