// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/descriptors/photo_maps.h"

#include <utility>

#include "bodyloom/data_tools/descriptors/posed_track.h"
#include "bodyloom/data_tools/descriptors/texels_of_pixels.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/uv_bake.h"
#include "bodyloom/render/resolve_pixels.h"
#include "bodyloom/render/texel_sight.h"
#include "bodyloom/render/visibility_buffer.h"

namespace bodyloom {
namespace {

PersonWindow SquareWindow(const PosedTrack& posed, const Camera& camera, const PhotoMapsOptions& options) {
  PersonWindowOptions window;
  window.max_side = window.multiple = options.size;
  window.margin = options.margin;
  return PlanPersonWindow(posed.Extents(options.num_threads), camera.width, camera.height, window);
}

}  // namespace

std::vector<uint8_t> PartsOfTexels(const BodyModel& body, const UvTexelTable& texels) {
  BODYLOOM_CHECK(body.has_parts(), "parts of texels: the body model has no parts");
  std::vector<uint8_t> parts(size_t(texels.width) * texels.height, 0);
  for (size_t i = 0; i < texels.size(); ++i) parts[texels.pixel[i]] = body.data().face_part[texels.face[i]];
  return parts;
}

std::vector<float> PlacesOfTexels(const BodyModel& body, const UvTexelTable& texels) {
  const MatrixX3d& vertices = body.data().v_template;
  std::vector<float> values;
  for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
    for (int a = 0; a < 3; ++a) values.push_back(static_cast<float>(vertices(v, a)));
  }
  const UvBaker baker(texels, body.data().faces);
  std::vector<float> places(3 * static_cast<size_t>(baker.num_pixels()), 0);
  baker.Bake(InterleaveChannels(values, body.num_vertices(), 3), body.num_vertices(), 3, places);
  return places;
}

class PhotoMaps::Impl {
 public:
  Impl(const BodyModel& body, const Track& track, const PhotoMapsOptions& options)
      : body_(body), track_(track), options_(options), posed_(body, track, options.yaw_deg) {
    BODYLOOM_CHECK(options.size > 0 && options.texture_size > 0, "photo maps: a window of ", options.size,
                   " pixels, a texture of ", options.texture_size, " texels");
    BODYLOOM_CHECK(body.has_parts(), "photo maps: the body model has no parts");
    BODYLOOM_CHECK(options.yaw_deg.empty() || options.estimated == nullptr,
                   "photo maps: estimates show the picture's own view");
    window_ = SquareWindow(posed_, track.camera, options);
    table_ = options.texels;
    if (table_ == nullptr) {
      UvTexelOptions texels;
      texels.width = texels.height = options.texture_size;
      table_ = std::make_shared<const UvTexelTable>(BuildUvTexelTable(body, texels));
    }
    BODYLOOM_CHECK(table_->width == options.texture_size && table_->height == options.texture_size,
                   "photo maps: texels of ", table_->width, "x", table_->height, " for a texture of ",
                   options.texture_size);
    if (options.estimated != nullptr) texel_parts_ = PartsOfTexels(body, *table_);
  }

  [[nodiscard]] PhotoMap At(int t) const {
    const size_t area = size_t(options_.size) * options_.size, texels = size_t(table_->width) * table_->height;
    PhotoMap map;
    map.uv.assign(2 * area, 0);
    map.parts.assign(area, 0);
    map.texel_pixels.assign(2 * texels, 0);
    map.texel_cosine.assign(texels, 0);
    if (!track_.HasResult(t)) return map;
    if (options_.estimated != nullptr) {
      FillEstimated(t, &map);
      return map;
    }
    const MatrixX3d vertices = posed_.Vertices(t);
    const Camera camera = CameraInWindow(track_.CameraAt(t), window_, t);
    VisibilityBuffer buffer;
    buffer.Render(vertices, body_.data().faces, camera);
    FillPixels(vertices, camera, buffer, &map);
    TexelSightOptions sight;
    sight.min_cosine = 0.15;
    sight.whole_footprint = true;  // no colour of what lies behind
    const std::vector<TexelSight> seen = SeeTexels(*table_, body_, vertices, camera, buffer, sight);
    for (size_t i = 0; i < table_->size(); ++i) {
      if (!(seen[i].cosine > 0)) continue;
      const size_t at = table_->pixel[i];
      map.texel_pixels[at] = seen[i].x_px;
      map.texel_pixels[texels + at] = seen[i].y_px;
      map.texel_cosine[at] = seen[i].cosine;
    }
    return map;
  }

  [[nodiscard]] const PersonWindow& window() const { return window_; }
  [[nodiscard]] const std::shared_ptr<const UvTexelTable>& texels() const { return table_; }

 private:
  void FillEstimated(int t, PhotoMap* map) const {
    std::vector<float> mask(map->parts.size());
    options_.estimated->BodyMaps(window_, t, map->uv, mask, map->parts);
    TexelPlaces places =
        TexelsOfPixels(map->uv, map->parts, options_.size, options_.size, texel_parts_, options_.texture_size);
    map->texel_pixels = std::move(places.pixels), map->texel_cosine = std::move(places.seen);
  }

  void FillPixels(const MatrixX3d& vertices, const Camera& camera, const VisibilityBuffer& buffer,
                  PhotoMap* map) const {
    ResolveRequest request;
    request.atlas_uv = request.part = true;
    ResolvedPixels pixels;
    ResolvePixels(buffer, body_, vertices, camera, request, &pixels);
    const PixelBox& box = pixels.box;
    const size_t area = map->parts.size();
    for (int y = box.y_begin; y < box.y_end; ++y) {
      for (int x = box.x_begin; x < box.x_end; ++x) {
        if (buffer.FaceAt(x, y) < 0) continue;
        const size_t at = size_t(y) * options_.size + x, from = box.IndexOf(x, y);
        map->uv[at] = pixels.atlas_uv[2 * from];
        map->uv[area + at] = pixels.atlas_uv[2 * from + 1];
        map->parts[at] = pixels.part[from];
      }
    }
  }

  const BodyModel& body_;
  const Track& track_;
  PhotoMapsOptions options_;
  PosedTrack posed_;
  PersonWindow window_;
  std::shared_ptr<const UvTexelTable> table_;
  std::vector<uint8_t> texel_parts_;  ///< where there are estimates
};

PhotoMaps::PhotoMaps(const BodyModel& body, const Track& track, const PhotoMapsOptions& options)
    : impl_(std::make_unique<Impl>(body, track, options)) {}
PhotoMaps::~PhotoMaps() = default;
PhotoMaps::PhotoMaps(PhotoMaps&&) noexcept = default;
const PersonWindow& PhotoMaps::window() const { return impl_->window(); }
PhotoMap PhotoMaps::At(int t) const { return impl_->At(t); }
const std::shared_ptr<const UvTexelTable>& PhotoMaps::texels() const { return impl_->texels(); }

}  // namespace bodyloom
