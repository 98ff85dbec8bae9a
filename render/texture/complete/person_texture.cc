// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/person_texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "render/image/image.h"
#include "render/texture/complete/uv_fill.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

Image ColourImage(const Texture& texture, const std::vector<float>& planes) {
  Image image(texture.width, texture.height);
  const size_t pixels = size_t(texture.width) * texture.height;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t c = 0; c < 3; ++c) image.bgr[3 * p + c] = UnitByte(planes[c * pixels + p]);
  }
  return image;
}

Image GreyImage(const Texture& texture, const std::vector<float>& plane) {
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c) planes.insert(planes.end(), plane.begin(), plane.end());
  return ColourImage(texture, planes);
}

int HundredthOfTheHeight(const Track& track) {
  std::vector<double> heights_px;
  for (int t = 0; t < static_cast<int>(track.joints.size()); ++t) {
    double low = 1e9, high = -1e9;
    Eigen::Vector2d pixel;
    for (Eigen::Index j = 0; j < track.joints[t].rows(); ++j) {
      if (!track.CameraAt(t).Project(track.joints[t].row(j).transpose(), &pixel)) continue;
      low = std::min(low, pixel.y());
      high = std::max(high, pixel.y());
    }
    if (high > low) heights_px.push_back(high - low);
  }
  if (heights_px.empty()) return 2;
  std::nth_element(heights_px.begin(), heights_px.begin() + heights_px.size() / 2, heights_px.end());
  return static_cast<int>(std::clamp(std::lround(0.01 * heights_px[heights_px.size() / 2]), 1L, 64L));
}

TextureExtractOptions ExtractOptions(const PersonTextureOptions& options, int margin_px) {
  TextureExtractOptions extract;
  extract.texels.width = extract.texels.height = options.size;
  extract.edge_margin_px = margin_px;
  extract.merge = options.merge;
  return extract;
}

}  // namespace

bool HasFitOfItsOwn(const Track& track, int t) {
  const FrameStatus status = track.frame_status[t];
  return track.motion.HasPose(t) && (status == FrameStatus::kTracked || status == FrameStatus::kWeak);
}

PersonTexture::PersonTexture(const BodyModel& body, const Track& track, const PersonTextureOptions& options)
    : body_(body),
      track_(track),
      options_(options),
      margin_px_(options.margin_px >= 0 ? options.margin_px : HundredthOfTheHeight(track)),
      extractor_(body, ExtractOptions(options, margin_px_)) {}

bool PersonTexture::Add(int t, const Image& image) {
  if (!HasFitOfItsOwn(track_, t)) return false;
  extractor_.Add(image, TrackVertices(body_, track_, t), track_.CameraAt(t), t);
  return true;
}

std::optional<PersonTextureImages> PersonTexture::Merge() const {
  Texture texture = extractor_.Merge();
  if (texture.num_seen == 0) return std::nullopt;
  const UvTexelTable& table = extractor_.table();
  std::vector<uint8_t> known(texture.confidence.size());
  for (size_t p = 0; p < known.size(); ++p) {
    known[p] = texture.confidence[p] > (options_.fill != TextureFill::kNone ? options_.trust : 0);
  }
  if (options_.fill == TextureFill::kNone) {
    FillGutter(body_, table, known, 3, texture.bgr);
  } else if (options_.fill == TextureFill::kLaplace) {
    LaplaceFill(body_, table, known).Fill(3, texture.bgr);
  } else {
    PyramidFill(body_, table).Fill(known, 3, texture.bgr);
  }
  return PersonTextureImages{ColourImage(texture, texture.bgr), GreyImage(texture, texture.confidence),
                             texture.num_seen};
}

}  // namespace bodyloom
