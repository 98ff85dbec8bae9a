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

Image OriginImage(const CoherentMaps& maps, int num_photos) {
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

Image GuidedMapsSheet(const CoherentMaps& maps, std::span<const RenderedPerson> virtual_images, int num_photos) {
  std::vector<Image> images = {ImageFromPlanes(maps.appearance, maps.size, maps.size),
                               LabelsImage(maps.labels, maps.size, maps.size), OriginImage(maps, num_photos)};
  for (const RenderedPerson& p : virtual_images) images.push_back(ImageFromPlanes(p.image, p.size, p.size));
  for (const RenderedPerson& p : virtual_images) images.push_back(LabelsImage(p.labels, p.size, p.size));
  ContactSheetOptions options;
  options.columns = 3;
  options.cell_height_px = maps.size;
  return ContactSheet(images, options);
}

}  // namespace bodyloom
