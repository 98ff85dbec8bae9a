// SPDX-License-Identifier: Apache-2.0
/// A person as made from photos, with known appearance.
#pragma once

#include "data_tools/body/builtin_body.h"
#include "render/photo_avatar/photo_person.h"

namespace bodyloom {

/// The built-in body with a colour gradient over the atlas; its left half was seen, the other mirrored.
inline PhotoPerson ColouredPerson() {
  PhotoPerson person;
  person.bare = person.clothed = person.body = BodyOrBuiltin("");
  person.betas = Eigen::VectorXd::Zero(2);
  person.texture = Image(64, 64);
  person.sources = Image(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      uint8_t *colour = person.texture.pixel(x, y), *source = person.sources.pixel(x, y);
      colour[0] = static_cast<uint8_t>(2 * x), colour[1] = static_cast<uint8_t>(2 * y), colour[2] = 200;
      source[0] = 255, source[1] = source[2] = x < 32 ? 255 : 0;
    }
  }
  return person;
}

}  // namespace bodyloom
