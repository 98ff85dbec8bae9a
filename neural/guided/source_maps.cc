// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/source_maps.h"

#include <optional>
#include <vector>

#include "geometry/base/check.h"
#include "render/garment/clothes_offset_map.h"
#include "render/texture/complete/guess_unseen.h"

namespace bodyloom {
namespace {

/// The photo restricted to texels where `lent` equals where_lent.
PhotoFrame ShownAlone(const PhotoFrame& photo, std::span<const uint8_t> lent, bool where_lent) {
  PhotoFrame shown = photo;
  for (size_t i = 0; i < lent.size(); ++i) {
    if ((lent[i] != 0) != where_lent) shown.texel_cosine[i] = 0;
  }
  return shown;
}

/// The photo with labels reduced to person and background.
PhotoFrame WithoutGarments(const PhotoFrame& photo) {
  PhotoFrame shown = photo;
  for (uint8_t& label : shown.labels) label = label != 0 ? 1 : 0;
  return shown;
}

/// Copies a photo's texels to the maps where it sees them at a larger cosine than the photos before. Returns the number
/// of previously empty ones.
int TakeBetterSeen(const CoherentMaps& of_photo, std::span<const float> cosine, std::vector<float>* seen_at,
                   CoherentMaps* maps) {
  const size_t texels = maps->from.size();
  int filled = 0;
  for (size_t i = 0; i < texels; ++i) {
    if (of_photo.from[i] == 0 || !(cosine[i] > (*seen_at)[i])) continue;
    filled += maps->from[i] == 0 ? 1 : 0;
    (*seen_at)[i] = cosine[i];
    maps->from[i] = of_photo.from[i];
    maps->labels[i] = of_photo.labels[i];
    for (size_t c = 0; c < 3; ++c) maps->appearance[c * texels + i] = of_photo.appearance[c * texels + i];
  }
  return filled;
}

}  // namespace

SourceMaps MapsOfSource(std::span<const PhotoFrame> photos, const SourceBody& body, MapCompletion completion,
                        bool clothes_offset, const DrawPose& draw) {
  BODYLOOM_CHECK(!photos.empty(), "pose-guided renderer: no photo");
  const bool views = body.virtual_views.size() == kNumVirtualViews;
  BODYLOOM_CHECK(completion != MapCompletion::kVirtualViews || views, "virtual views: ", body.virtual_views.size(),
                 ", expected ", int(kNumVirtualViews));
  BODYLOOM_CHECK((completion != MapCompletion::kNearest && !clothes_offset) || body.neighbours != nullptr,
                 "pose-guided renderer: the maps ask for the nearest texels, and nobody says which are near");
  std::vector<uint8_t> behind;  // of the head
  if (views && completion != MapCompletion::kNearest) {
    behind = TexelsOfTheBack(body.virtual_views[kViewFront], body.virtual_views[kViewBack]);
  } else if (body.neighbours != nullptr) {
    behind = body.neighbours->back_of_head();
  }
  SourceMaps source = {EmptyMaps(photos[0].texture_size, body.texel_parts), 0, {}};
  const std::span<const uint8_t> lent = body.lent_texels;
  BODYLOOM_CHECK(lent.empty() || (photos.size() > 1 && lent.size() == photos[0].texel_cosine.size() &&
                                  lent.size() == photos.back().texel_cosine.size()),
                 "pose-guided renderer: ", lent.size(), " texels lent among ", photos.size(), " photos");
  std::vector<float> seen_at(source.maps.from.size());  // cosines
  for (size_t i = 0; i < photos.size(); ++i) {
    std::optional<PhotoFrame> part;
    if (!lent.empty()) part = ShownAlone(photos[i], lent, /*where_lent=*/i + 1 == photos.size());
    if (!body.garments_known) part = WithoutGarments(part ? *part : photos[i]);
    const PhotoFrame& shown = part ? *part : photos[i];
    CoherentMaps of_photo = EmptyMaps(source.maps.size, body.texel_parts);
    FillEmptyTexels(shown, OwnImage(shown), static_cast<uint8_t>(i + 1), {}, &of_photo);
    source.texels_seen += TakeBetterSeen(of_photo, shown.texel_cosine, &seen_at, &source.maps);
  }
  if (!behind.empty()) RelabelBackOfHeadAsHair(behind, source.maps.labels);
  if (clothes_offset) {
    source.maps.clothes_offset = ClothesOffsetMap(photos[0], *body.neighbours);
    if (!lent.empty()) {
      const std::vector<float> of_lender = ClothesOffsetMap(photos.back(), *body.neighbours);
      for (size_t i = 0; i < lent.size(); ++i) {
        if (lent[i] != 0) source.maps.clothes_offset[i] = of_lender[i];
      }
    }
  }
  const int next = static_cast<int>(photos.size()) + 1;
  if (completion == MapCompletion::kNearest) {
    CompleteEmptyTexels(*body.neighbours, static_cast<uint8_t>(next), &source.maps);
  } else if (completion == MapCompletion::kVirtualViews) {
    source.virtual_images = CompleteMaps(body.virtual_views, draw, next, &source.maps);
  }
  return source;
}

int CompleteEmptyTexels(const TexelNeighbours& neighbours, uint8_t from, CoherentMaps* maps) {
  BODYLOOM_CHECK(from > 0 && neighbours.texture_size() == maps->size, "coherent maps: neighbours of ",
                 neighbours.texture_size(), " texels a side for maps of ", maps->size);
  const std::vector<uint8_t> guessed = GuessUnseen(neighbours, maps->labels, maps->appearance);
  int count = 0;
  for (size_t i = 0; i < guessed.size(); ++i) {
    if (guessed[i] == 0) continue;
    maps->from[i] = from;
    ++count;
  }
  return count;
}

}  // namespace bodyloom
