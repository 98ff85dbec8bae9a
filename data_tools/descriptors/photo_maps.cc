// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/photo_maps.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/uv_maps/uv_bake.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"
#include "render/texture/texel_visibility.h"
#include "render/uv_maps/posed_track.h"

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
                   "photo maps: estimates show the image's own view");
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
    TexelVisibilityOptions sight;
    sight.min_cosine = 0.15;
    sight.whole_footprint = true;  // no colour of surfaces behind
    const std::vector<TexelVisibility> seen = ComputeTexelVisibility(*table_, body_, vertices, camera, buffer, sight);
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

namespace {

using Eigen::Vector2d;

constexpr double kFarthest = 0.1;  ///< of the atlas: pixels farther apart there lie on different sheets of the surface
constexpr double kInside = 1e-6;   ///< of barycentric coordinates: beyond the triangle
constexpr double kHalfAPixel = 0.5;

struct MapCorner {
  Vector2d pixel, texel;
};

/// Texels whose centres lie within the triangle, or at most `beyond` outside it, and that have no position yet.
void FillTriangle(const std::array<MapCorner, 3>& corners, double beyond, uint8_t part,
                  std::span<const uint8_t> texel_parts, int U, TexelPlaces* places) {
  const Vector2d a = corners[0].texel, ab = corners[1].texel - a, ac = corners[2].texel - a;
  if (std::max({ab.norm(), ac.norm(), (ab - ac).norm()}) > kFarthest * U) return;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (area == 0) return;
  const Vector2d lowest = a.cwiseMin(corners[1].texel).cwiseMin(corners[2].texel),
                 highest = a.cwiseMax(corners[1].texel).cwiseMax(corners[2].texel);
  // A coordinate of −beyond is as far from the triangle as so much of its extent, twice where two are.
  const Vector2d margin = 2 * beyond * (highest - lowest), low = lowest - margin, high = highest + margin;
  for (int r = std::max(0, static_cast<int>(std::ceil(low.y()))); r <= std::min<double>(U - 1, high.y()); ++r) {
    for (int c = std::max(0, static_cast<int>(std::ceil(low.x()))); c <= std::min<double>(U - 1, high.x()); ++c) {
      const size_t at = size_t(r) * U + c;
      if (texel_parts[at] != part || places->seen[at] != 0) continue;
      const Vector2d p = Vector2d(c, r) - a;
      const double of_b = (p.x() * ac.y() - p.y() * ac.x()) / area, of_c = (ab.x() * p.y() - ab.y() * p.x()) / area;
      if (std::min({of_b, of_c, 1 - of_b - of_c}) < -beyond) continue;
      const Vector2d pixel = (1 - of_b - of_c) * corners[0].pixel + of_b * corners[1].pixel + of_c * corners[2].pixel;
      places->seen[at] = 1;
      places->pixels[at] = static_cast<float>(pixel.x());
      places->pixels[size_t(U) * U + at] = static_cast<float>(pixel.y());
    }
  }
}

}  // namespace

TexelPlaces TexelsOfPixels(std::span<const float> uv, std::span<const uint8_t> parts, int width, int height,
                           std::span<const uint8_t> texel_parts, int texture_size) {
  const int U = texture_size;
  const size_t area = size_t(width) * height, texels = size_t(U) * U;
  BODYLOOM_CHECK(uv.size() == 2 * area && parts.size() == area && texel_parts.size() == texels,
                 "texels of pixels: coordinates, parts and texels of ", uv.size(), ", ", parts.size(), " and ",
                 texel_parts.size(), " values, expected those of ", width, "x", height, " and of ", U, "x", U);
  TexelPlaces places = {std::vector<float>(2 * texels, 0), std::vector<float>(texels, 0)};
  const auto corner = [&](int x, int y) {
    const size_t i = size_t(y) * width + x;
    return MapCorner{Vector2d(x, y), Vector2d(uv[i] * U - 0.5, (1 - uv[area + i]) * U - 0.5)};
  };
  const auto part = [&](int x, int y) { return parts[size_t(y) * width + x]; };
  // Finally the rim of the pixels that show a part: a pixel covers half a pixel around its centre.
  for (const double beyond : {kInside, kHalfAPixel}) {
    for (int y = 0; y + 1 < height; ++y) {
      for (int x = 0; x + 1 < width; ++x) {
        // The diagonal from upper right to lower left is in both halves of the square.
        const uint8_t shared = part(x + 1, y);
        if (shared == 0 || shared != part(x, y + 1)) continue;
        const MapCorner right = corner(x + 1, y), below = corner(x, y + 1);
        for (const int k : {0, 1}) {
          if (part(x + k, y + k) != shared) continue;
          FillTriangle({corner(x + k, y + k), right, below}, beyond, shared, texel_parts, U, &places);
        }
      }
    }
  }
  return places;
}

}  // namespace bodyloom
