// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/synthesis/people/dressed_person.h"

#include <utility>

#include "bodyloom/data_tools/synthesis/people/garment_of_outfit.h"

namespace bodyloom {

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed,
                             ClothesStyle style, ClothStuff stuff)
    : DressedPerson(body, betas, Outfit(body, kind, seed, style), seed, stuff) {}

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, Outfit outfit, uint64_t seed,
                             ClothStuff stuff)
    : ClothWearer(body, betas, outfit.offsets_m()), outfit_(std::move(outfit)) {
  const LooseGarmentOptions options = LooseGarmentOf(outfit_, rest_joints(), seed);
  if (options.length_m > 0) Wear(Cut(SewnOf(stuff, options), seed));
}

}  // namespace bodyloom
