// SPDX-License-Identifier: Apache-2.0
#include "render/texture/planar_image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/image/image.h"

namespace bodyloom {
namespace {

// Background, top, bottom, face, hair, skin, shoes.
constexpr std::array<Colour, 7> kLabelColours = {
    {{0, 0, 0}, {66, 135, 205}, {216, 120, 50}, {246, 205, 160}, {120, 72, 40}, {226, 172, 128}, {150, 60, 160}}};

}  // namespace

Image ImageFromPlanes(std::span<const float> planar, int width, int height) {
  Image image(width, height);
  const size_t area = size_t(width) * height;
  for (size_t i = 0; i < area; ++i) {
    for (int c = 0; c < 3; ++c) image.bgr[3 * i + c] = UnitByte(planar[area * (2 - c) + i]);
  }
  return image;
}

Image NormalImage(std::span<const float> planar, int width, int height) {
  Image image(width, height);
  const size_t area = size_t(width) * height;
  for (size_t i = 0; i < area; ++i) {
    const float x = planar[i], y = planar[area + i], z = planar[2 * area + i];
    if (x * x + y * y + z * z < 0.04F) continue;
    image.bgr[3 * i] = UnitByte(0.5F * (1 - z));
    image.bgr[3 * i + 1] = UnitByte(0.5F * (1 - y));
    image.bgr[3 * i + 2] = UnitByte(0.5F * (1 + x));
  }
  return image;
}

Image LabelsImage(std::span<const uint8_t> labels, int width, int height) {
  Image image(width, height);
  for (size_t i = 0; i < labels.size(); ++i) {
    const Colour colour = kLabelColours[labels[i] % kLabelColours.size()];
    image.bgr[3 * i] = colour.blue;
    image.bgr[3 * i + 1] = colour.green;
    image.bgr[3 * i + 2] = colour.red;
  }
  return image;
}

}  // namespace bodyloom
