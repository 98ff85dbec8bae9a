// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/neural/guided/source_maps.h"

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/neural/guided/clothes_extent.h"
#include "bodyloom/neural/guided/guess_maps.h"
#include "bodyloom/neural/people/guess_unseen.h"

namespace bodyloom {

SourceMaps MapsOfSource(std::span<const PhotoFrame> photos, const SourceBody& body, MapCompletion completion,
                        bool extent, const DrawPose& draw) {
  BODYLOOM_CHECK(!photos.empty(), "pose-guided renderer: no photo");
  const bool views = body.virtual_views.size() == kNumVirtualViews;
  BODYLOOM_CHECK(completion != MapCompletion::kVirtualViews || views, "virtual views: ", body.virtual_views.size(),
                 ", expected ", int(kNumVirtualViews));
  BODYLOOM_CHECK((completion != MapCompletion::kNearest && !extent) || body.neighbours != nullptr,
                 "pose-guided renderer: the maps ask for the nearest texels, and nobody says which are near");
  std::vector<uint8_t> behind;  // of the head
  if (views && completion != MapCompletion::kNearest) {
    behind = TexelsOfTheBack(body.virtual_views[kViewFront], body.virtual_views[kViewBack]);
  } else if (body.neighbours != nullptr) {
    behind = body.neighbours->back_of_head();
  }
  SourceMaps source = {EmptyMaps(photos[0].texture_size, body.texel_parts), 0, {}};
  for (size_t i = 0; i < photos.size(); ++i) {
    source.texels_seen +=
        FillEmptyTexels(photos[i], OwnPicture(photos[i]), static_cast<uint8_t>(i + 1), {}, &source.maps);
  }
  if (!behind.empty()) CallFacesBehindHair(behind, source.maps.labels);
  if (extent) source.maps.extent = ClothesExtent(photos[0], *body.neighbours);
  const int next = static_cast<int>(photos.size()) + 1;
  if (completion == MapCompletion::kNearest) {
    GuessRest(*body.neighbours, static_cast<uint8_t>(next), &source.maps);
  } else if (completion == MapCompletion::kVirtualViews) {
    source.virtual_pictures = CompleteMaps(body.virtual_views, draw, next, &source.maps);
  }
  return source;
}

}  // namespace bodyloom
