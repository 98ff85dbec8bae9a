// SPDX-License-Identifier: Apache-2.0
/// Dresses a person made from photos in the clothes of another one. Both bodies share one surface, so colours and
/// offsets transfer point by point.
///
///   where the other wears something     the other's colour and offset from the skin
///   where both are bare, and the head   the person's own
///   where only the person is clothed    the person's median skin colour, times the other's brightness at that point
///                                       relative to its median; offset at most the other's
///
/// A loose garment is cut for the person by the other's measures, its waist at the same height above the hips in units
/// of the trunk's length.
#pragma once

#include "render/photo_avatar/photo_person.h"

namespace bodyloom {

/// Both must be made with the same bare body. The person's light, tracks, texture size and report are kept, except for
/// the garment's length. Throws std::invalid_argument for people of different bodies, a person without texel labels
/// (saved by an older version), and a garment that cannot be cut for this person.
PhotoPerson TransferClothes(const PhotoPerson& person, const PhotoPerson& other);

}  // namespace bodyloom
