// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/dressed_person.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/hash_random.h"

namespace bodyloom {

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed,
                             ClothesStyle style, ClothMaterial material)
    : DressedPerson(body, betas, Outfit(body, kind, seed, style), seed, material) {}

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, Outfit outfit, uint64_t seed,
                             ClothMaterial material)
    : ClothCollisionBody(body, betas, outfit.offsets_m()), outfit_(std::move(outfit)) {
  const LooseGarmentOptions options = LooseGarmentOf(outfit_, rest_joints(), seed);
  if (options.length_m > 0) Wear(Cut(GarmentOptionsFor(material, options), seed));
}

LooseGarmentOptions LooseGarmentOf(const Outfit& outfit, const MatrixX3d& rest_joints, uint64_t seed) {
  HashRandom random(seed, {0x6c6f6f73});
  LooseGarmentOptions o;
  const double pelvis = rest_joints(0, 1), knee = rest_joints(4, 1), ankle = rest_joints(7, 1),
               spine1 = rest_joints(3, 1), spine2 = rest_joints(6, 1), shoulder = rest_joints(16, 1);
  switch (outfit.kind()) {
    case GarmentKind::kSuit:
      o.length_m = 0;
      break;
    case GarmentKind::kSkirt:
      o.waist_y_m = pelvis + random.Uniform(0.7, 0.9) * (spine1 - pelvis);
      o.fullness = random.Uniform(0.4, 0.62);
      o.length_m =
          (o.waist_y_m - knee + random.Uniform(-0.12, 0.08) * (knee - ankle)) / std::sqrt(1 - 0.25 * o.fullness);
      break;
    case GarmentKind::kCoat:
      o.waist_y_m = std::min(0.35 * spine1 + 0.65 * spine2, shoulder - 0.12);
      o.fullness = random.Uniform(0.22, 0.32);
      o.length_m = o.waist_y_m - (0.5 * rest_joints(1, 1) + 0.5 * knee) + random.Uniform(-0.05, 0.1);
      o.slit_from_m = o.waist_y_m - pelvis + random.Uniform(-0.05, 0.05);
      break;
  }
  return o;
}

}  // namespace bodyloom
