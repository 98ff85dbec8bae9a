// SPDX-License-Identifier: Apache-2.0
/// A body in the clothes of a synthetic person, with the simulation of its loose garment.
///
/// The clothes close to the skin are the skinned surface moved outwards along its normals (outfit.h); the loose garment
/// is cloth pinned to that surface and colliding with it (geometry/cloth/cloth_run.h). It depends on the past motion:
/// the same pose at another speed gives other folds.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "data_tools/synthesis/people/outfit.h"
#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/cloth/cloth_material.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"

namespace bodyloom {

/// Immutable, may be shared by threads. The body must outlive it.
class DressedPerson : public ClothCollisionBody {
 public:
  /// Throws std::invalid_argument when the body does not have SMPL's joints or there are more betas than components.
  DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed,
                ClothesStyle style = ClothesStyle::kPatterned, ClothMaterial material = ClothMaterial::kCotton);
  DressedPerson(BodyModel&&, const Eigen::VectorXd&, GarmentKind, uint64_t, ClothesStyle = ClothesStyle::kPatterned,
                ClothMaterial = ClothMaterial::kCotton) = delete;

  [[nodiscard]] const Outfit& outfit() const { return outfit_; }

 private:
  DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, Outfit outfit, uint64_t seed,
                ClothMaterial material);
  Outfit outfit_;
};

// Cut of the loose garment of a synthetic person's outfit.

/// Options of the garment for an outfit's kind and seed on a body with these joints (J×3, T-pose, SMPL's tree), with
/// the height of the pinned ring scaled accordingly; for a suit, which has none, length_m is 0.
LooseGarmentOptions LooseGarmentOf(const Outfit& outfit, const MatrixX3d& rest_joints, uint64_t seed);

}  // namespace bodyloom
