// SPDX-License-Identifier: Apache-2.0
/// A person made from photos in the clothes of another one: the body's surface is the same in both, so what a point
/// shows of the other can be put on the point of this one.
///
///   where the other wears something     the other's colour, and as far off the skin as there
///   where both are bare, and the head   as the person is
///   where only the person wears something there   the median colour of the person's skin, as bright as the other's
///                                       skin is at that point beside its median; no further off than the other's
///
/// A loose garment is cut for the person by the other's measures, its waist as far above the hips in units of the
/// trunk's length.
#pragma once

#include "render/photo_avatar/photo_person.h"

namespace bodyloom {

/// Both made with the same bare body. The person's light, tracks and size of texture stay, and the report of
/// the person's own photos, but for the garment's length. Throws std::invalid_argument for
/// people of different bodies, a person whose texels have no labels (kept before there were any), and a garment that
/// cannot be cut for this person.
PhotoPerson InClothesOf(const PhotoPerson& person, const PhotoPerson& other);

}  // namespace bodyloom
