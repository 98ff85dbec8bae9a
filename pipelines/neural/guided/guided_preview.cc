// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/guided/guided_preview.h"

#include <algorithm>
#include <array>

#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr std::array<Colour, 6> kViewColours = {
    {{230, 60, 60}, {60, 160, 230}, {80, 200, 90}, {240, 180, 40}, {180, 80, 220}, {60, 210, 200}}};

Image OriginPicture(const CoherentMaps& maps, int num_photos) {
  Image image(maps.size, maps.size);
  for (size_t i = 0; i < maps.from.size(); ++i) {
    const int number = maps.from[i] - 1;
    if (number < 0) continue;
    const int grey = std::max(90, 230 - 45 * number);
    const Colour colour = number < num_photos ? Colour{uint8_t(grey), uint8_t(grey), uint8_t(grey)}
                                              : kViewColours[(number - num_photos) % kViewColours.size()];
    image.bgr[3 * i] = colour.blue;
    image.bgr[3 * i + 1] = colour.green;
    image.bgr[3 * i + 2] = colour.red;
  }
  return image;
}

}  // namespace

Image GuidedMapsSheet(const CoherentMaps& maps, std::span<const PersonPicture> virtual_pictures, int num_photos) {
  std::vector<Image> pictures = {PictureOf(maps.appearance, maps.size, maps.size),
                                 LabelsPicture(maps.labels, maps.size, maps.size), OriginPicture(maps, num_photos)};
  for (const PersonPicture& p : virtual_pictures) pictures.push_back(PictureOf(p.image, p.size, p.size));
  for (const PersonPicture& p : virtual_pictures) pictures.push_back(LabelsPicture(p.labels, p.size, p.size));
  ContactSheetOptions options;
  options.columns = 3;
  options.cell_height_px = maps.size;
  return ContactSheet(pictures, options);
}

}  // namespace bodyloom
