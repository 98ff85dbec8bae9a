// SPDX-License-Identifier: Apache-2.0
/// A texture from an image and its dense labels alone, when there is no tracked mesh to gather with: every labelled
/// pixel is spread over the texels it covers. Where a mesh is known render/texture_extract.h gives the better texture.
///
/// A pixel with part I and chart coordinates (u, v) lies at a place of the atlas (render/chart_lookup.h). How many
/// texels it covers follows from the places of its neighbours in the same chart; its colour is added there with a cone
/// of that radius, weighted by 1/area, so that stretched pixels fill the gaps between them without outweighing sharp
/// ones. Texels of other charts are left alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/uv_texels.h"
#include "bodyloom/render/chart_lookup.h"
#include "bodyloom/render/image.h"
#include "bodyloom/render/texture_extract.h"
#include "bodyloom/render/uv_sample.h"

namespace bodyloom {

class UvSplatter {
 public:
  /// Throws std::invalid_argument when the body has no parts, chart coordinates or UV.
  UvSplatter(const BodyModel& body, const UvTexelOptions& texels = {.width = 512, .height = 512, .gutter = 1});

  [[nodiscard]] const UvTexelTable& table() const { return table_; }

  /// Labels of every pixel of the image: part 1 to 24 (0: none), (u, v) in [0, 1]. A label that is not finite, or of a
  /// part that the body lacks, is passed over. Returns the pixels used. Throws std::invalid_argument when sizes differ.
  int Add(const Image& image, std::span<const uint8_t> part, std::span<const float> u, std::span<const float> v);

  /// Mean colours; confidence is the weight gathered, at most 1.
  [[nodiscard]] Texture Merge() const;

 private:
  const BodyModel& body_;
  UvCharts charts_;
  UvTexelTable table_;
  ChartLookup lookup_;
  std::vector<float> sum_, weight_;  ///< three planes; one
};

}  // namespace bodyloom
