// SPDX-License-Identifier: Apache-2.0
#include "render/raster/visibility_buffer.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"

namespace bodyloom {
namespace {

// Clips faces that reach behind the near plane or far outside the image, so that they can be projected.

/// A convex polygon of at most 3 + 5 corners in the camera frame, in the order of the face it was cut from.
struct ClippedPolygon {
  std::array<Eigen::Vector3d, 8> corners;
  int size = 0;
};

using Eigen::Vector3d;
using Eigen::Vector4d;

/// Keeps the part of the polygon with plane · (x, y, z, 1) >= 0. A crossing is always computed from the corner inside
/// to the corner outside, so the two faces of a shared edge get the same point.
void ClipAtPlane(const Vector4d& plane, ClippedPolygon* polygon) {
  ClippedPolygon kept;
  const auto side = [&](const Vector3d& x) { return plane.head<3>().dot(x) + plane.w(); };
  for (int i = 0; i < polygon->size; ++i) {
    const Vector3d& p = polygon->corners[i];
    const Vector3d& q = polygon->corners[(i + 1) % polygon->size];
    const double side_p = side(p), side_q = side(q);
    if (side_p >= 0) kept.corners[kept.size++] = p;
    if (side_p >= 0 && side_q < 0) {
      kept.corners[kept.size++] = p + (side_p / (side_p - side_q)) * (q - p);
    } else if (side_p < 0 && side_q >= 0) {
      kept.corners[kept.size++] = q + (side_q / (side_q - side_p)) * (p - q);
    }
  }
  *polygon = kept;
}

/// The four planes that bound |x_px| and |y_px| by the guard band (less a pixel for rounding).
std::array<Vector4d, 4> GuardPlanes(const Camera& camera, double guard_px) {
  const double limit = guard_px - 1;
  if (camera.model == CameraModel::kWeakPerspective) {
    const double s = camera.scale, x = s * camera.tx + camera.cx, y = s * camera.ty + camera.cy;
    return {Vector4d(s, 0, 0, limit + x), Vector4d(-s, 0, 0, limit - x), Vector4d(0, s, 0, limit + y),
            Vector4d(0, -s, 0, limit - y)};
  }
  return {Vector4d(camera.fx, 0, camera.cx + limit, 0), Vector4d(-camera.fx, 0, limit - camera.cx, 0),
          Vector4d(0, camera.fy, camera.cy + limit, 0), Vector4d(0, -camera.fy, limit - camera.cy, 0)};
}

/// The part of a triangle (camera frame, metres) with z >= near_m (pinhole only) and |x_px|, |y_px| < guard_px; may be
/// empty. Clipped in space, before any division by depth. The two faces of a shared edge are clipped at the same
/// points. With lens distortion only the near plane clips, because edges are not straight on the screen.
ClippedPolygon ClipTriangle(const std::array<Vector3d, 3>& corners, const Camera& camera, double near_m,
                            double guard_px) {
  ClippedPolygon polygon;
  polygon.size = 3;
  for (int c = 0; c < 3; ++c) polygon.corners[c] = corners[c];
  if (camera.model == CameraModel::kPinhole) {
    // Clipped corners must satisfy z >= near_m despite rounding.
    ClipAtPlane(Vector4d(0, 0, 1, -near_m * (1 + 1e-9)), &polygon);
  }
  if (camera.HasDistortion()) return polygon;
  for (const Vector4d& plane : GuardPlanes(camera, guard_px)) {
    if (polygon.size == 0) break;
    ClipAtPlane(plane, &polygon);
  }
  return polygon;
}
using raster_internal::kGuardBandPx;
using raster_internal::kLanes;
using raster_internal::kSubpixels;
using raster_internal::kTileHeight;
using raster_internal::kTileWidth;
using raster_internal::kUnusable;
using raster_internal::LargeFace;
using raster_internal::ScreenExtent;
using raster_internal::ScreenVertex;

constexpr int kVerticesAChunk = 1024;  // a multiple of every vector's length

/// Large meshes get longer chunks: each chunk keeps a table as long as the image has tiles.
int FacesAChunk(int num_faces) { return std::max(2048, (num_faces + 15) / 16); }

int DivideUp(int a, int b) { return (a + b - 1) / b; }

raster_internal::Projection ProjectionOf(const Camera& camera, double near_m) {
  if (camera.model == CameraModel::kWeakPerspective) {
    return {false, camera.scale, camera.scale, camera.tx, camera.ty, camera.cx, camera.cy, 0};
  }
  return {true, camera.fx, camera.fy, 0, 0, camera.cx, camera.cy, near_m};
}

void Extend(int32_t x, int32_t y, ScreenExtent* extent) {
  extent->x_min = std::min(extent->x_min, x), extent->x_max = std::max(extent->x_max, x);
  extent->y_min = std::min(extent->y_min, y), extent->y_max = std::max(extent->y_max, y);
}

/// The pixels whose centres the extent holds.
PixelBox PixelsOf(const ScreenExtent& extent) {
  if (extent.x_min > extent.x_max) return {};
  return {(extent.x_min + kSubpixels - 1) >> 8, (extent.y_min + kSubpixels - 1) >> 8, (extent.x_max >> 8) + 1,
          (extent.y_max >> 8) + 1};
}

/// Counting sort of items 0..count−1 by the tiles that their pixels (PixelBox of an item, not empty) meet; within a
/// tile items ascend.
template <class BoxOf>
void SortByTile(int count, int tiles_across, int num_tiles, const BoxOf& box_of, std::vector<int32_t>* begin,
                std::vector<int32_t>* entries) {
  const auto for_tiles = [&](int i, const auto& use) {
    const PixelBox box = box_of(i);
    const unsigned x_first = unsigned(box.x_begin) / kTileWidth, x_last = unsigned(box.x_end - 1) / kTileWidth;
    const unsigned y_first = unsigned(box.y_begin) / kTileHeight, y_last = unsigned(box.y_end - 1) / kTileHeight;
    for (unsigned y = y_first; y <= y_last; ++y) {
      for (unsigned x = x_first; x <= x_last; ++x) use(y * tiles_across + x);
    }
  };
  begin->assign(static_cast<size_t>(num_tiles) + 2, 0);
  int32_t* const end = begin->data() + 1;  // end of each tile's entries, once all are placed
  for (int i = 0; i < count; ++i) for_tiles(i, [&](unsigned tile) { ++end[tile + 1]; });
  for (int t = 0; t < num_tiles; ++t) end[t + 1] += end[t];
  entries->resize(end[num_tiles]);
  int32_t* const to = entries->data();
  for (int i = 0; i < count; ++i) for_tiles(i, [&](unsigned tile) { to[end[tile]++] = i; });
}

}  // namespace

/// Faces of one range of indices, sorted by the tiles they meet.
struct VisibilityBuffer::Chunk {
  int first = 0, last = 0;
  raster_internal::SmallFaces small;
  std::vector<LargeFace> large;
  std::vector<int32_t> others;
  std::vector<int32_t> small_begin, small_entries, large_begin, large_entries;  ///< by tile
};

/// Data of the faces being drawn, in screen coordinates.
struct VisibilityBuffer::Drawing {
  std::vector<ScreenVertex> vertices;
  raster_internal::ScreenArrays screen;
  std::vector<ScreenExtent> extents;
  std::vector<Chunk> chunks;  ///< the last one holds pieces of clipped faces
};

VisibilityBuffer::VisibilityBuffer() = default;
VisibilityBuffer::~VisibilityBuffer() = default;
VisibilityBuffer::VisibilityBuffer(VisibilityBuffer&&) noexcept = default;
VisibilityBuffer& VisibilityBuffer::operator=(VisibilityBuffer&&) noexcept = default;

bool VisibilityBuffer::ToScreen(const Vector3d& point, ScreenVertex* screen) const {
  const bool is_pinhole = camera_.model == CameraModel::kPinhole;
  Eigen::Vector2d pixel;
  if (is_pinhole && !(point.z() >= options_.near_m)) return false;
  if (!camera_.Project(point, &pixel) || !(pixel.cwiseAbs().maxCoeff() < kGuardBandPx)) return false;
  *screen = {static_cast<int32_t>(std::floor(pixel.x() * kSubpixels + 0.5)),
             static_cast<int32_t>(std::floor(pixel.y() * kSubpixels + 0.5)),
             static_cast<float>(is_pinhole ? 1 / point.z() : -point.z()), 0};
  return true;
}

void VisibilityBuffer::ProjectChunk(const MatrixX3d& vertices, int chunk) {
  const int first = chunk * kVerticesAChunk, last = std::min(num_vertices_, first + kVerticesAChunk);
  ScreenExtent& extent = drawing_->extents[chunk];
  if (is_linear_) {
    raster_internal::ProjectVertices(ProjectionOf(camera_, options_.near_m), vertices.data(), first, last,
                                     drawing_->screen, &extent);
    return;
  }
  for (int v = first; v < last; ++v) {
    const Vector3d point = vertices.row(v).transpose();
    extent.all_finite = extent.all_finite && point.allFinite();
    if (ToScreen(point, &drawing_->vertices[v])) {
      Extend(drawing_->vertices[v].x, drawing_->vertices[v].y, &extent);
      projected_[v] = {camera_.fx * point.x() / point.z() + camera_.cx, camera_.fy * point.y() / point.z() + camera_.cy,
                       1 / point.z(), 0};
    } else {
      drawing_->vertices[v] = {kUnusable, 0, 0, 0};
      projected_[v] = {0, 0, std::numeric_limits<double>::quiet_NaN(), 0};
      extent.all_usable = false;
    }
  }
}

void VisibilityBuffer::ClipFaces(const MatrixX3d& vertices, const MatrixX3i& faces, ScreenExtent* extent) {
  Chunk& pieces = drawing_->chunks.back();
  for (int f = 0; f < faces.rows(); ++f) {
    std::array<Vector3d, 3> corners;
    bool usable = true;
    for (int c = 0; c < 3; ++c) {
      corners[c] = vertices.row(faces(f, c)).transpose();
      usable = usable && drawing_->vertices[faces(f, c)].x != kUnusable;
    }
    if (usable) continue;
    const ClippedPolygon polygon = ClipTriangle(corners, camera_, options_.near_m, kGuardBandPx);
    std::array<ScreenVertex, 8> screen;
    usable = true;
    for (int i = 0; i < polygon.size && usable; ++i) usable = ToScreen(polygon.corners[i], &screen[i]);
    if (!usable) continue;
    for (int i = 0; i < polygon.size; ++i) Extend(screen[i].x, screen[i].y, extent);
    for (int i = 2; i < polygon.size; ++i) pieces.large.push_back({{screen[0], screen[i - 1], screen[i]}, f});
  }
}

raster_internal::Box VisibilityBuffer::DrawnBox() const {
  return {box_.x_begin, box_.y_begin, box_.width(), box_.height()};
}

void VisibilityBuffer::PrepareFaces(const MatrixX3d& vertices, const MatrixX3i& faces) {
  ScreenExtent all;
  for (const ScreenExtent& extent : drawing_->extents) {
    if (extent.x_min <= extent.x_max) {
      Extend(extent.x_min, extent.y_min, &all);
      Extend(extent.x_max, extent.y_max, &all);
    }
    all.all_usable = all.all_usable && extent.all_usable;
    all.all_finite = all.all_finite && extent.all_finite;
  }
  BODYLOOM_CHECK(all.all_finite, "visibility buffer: vertices hold NaN or infinite values");
  const int num_faces = static_cast<int>(faces.rows()), faces_a_chunk = FacesAChunk(num_faces);
  drawing_->chunks.resize(DivideUp(num_faces, faces_a_chunk) + 1);
  for (size_t i = 0; i < drawing_->chunks.size(); ++i) {
    Chunk& chunk = drawing_->chunks[i];
    chunk.first = std::min(num_faces, static_cast<int>(i) * faces_a_chunk);
    chunk.last = std::min(num_faces, chunk.first + faces_a_chunk);
    chunk.large.clear();
  }
  if (!all.all_usable) ClipFaces(vertices, faces, &all);
  const PixelBox image{0, 0, camera_.width, camera_.height};
  box_ = options_.whole_image ? image : PixelsOf(all).ClippedTo(image);
  if (num_faces == 0 || box_.empty()) box_ = {};
  tiles_across_ = DivideUp(box_.width(), kTileWidth), tiles_down_ = DivideUp(box_.height(), kTileHeight);
  if (box_.area() > capacity_) {
    capacity_ = 0;
    face_.reset(), nearness_.reset();
    face_ = std::make_unique_for_overwrite<int32_t[]>(box_.area());
    nearness_ = std::make_unique_for_overwrite<float[]>(box_.area());
    capacity_ = box_.area();
  }
}

void VisibilityBuffer::SetUpChunk(const MatrixX3i& faces, int index) {
  Chunk& chunk = drawing_->chunks[index];
  chunk.others.clear();
  chunk.small.Reserve(chunk.last - chunk.first);
  raster_internal::SetUpFaces(faces.data(), chunk.first, chunk.last, drawing_->screen, DrawnBox(),
                              options_.cull_back_faces, &chunk.small, &chunk.others);
  for (const int f : chunk.others) {
    LargeFace face;
    face.face = f;
    bool usable = true;
    for (int c = 0; c < 3; ++c) {
      face.corners[c] = drawing_->vertices[faces(f, c)];
      usable = usable && face.corners[c].x != kUnusable;  // else its pieces are in the last chunk
    }
    if (usable) chunk.large.push_back(face);
  }
  SortIntoTiles(&chunk);
}

void VisibilityBuffer::SortIntoTiles(Chunk* chunk) const {
  const int num_tiles = tiles_across_ * tiles_down_;
  const raster_internal::SmallFaces& small = chunk->small;
  SortByTile(
      small.size, tiles_across_, num_tiles,
      [&](int i) {
        return PixelBox{small.x_begin[i], small.y_begin[i], small.x_end[i], small.y_end[i]};
      },
      &chunk->small_begin, &chunk->small_entries);
  const PixelBox drawn{0, 0, box_.width(), box_.height()};
  const auto box_of = [&](const LargeFace& f) {
    ScreenExtent extent;
    for (const ScreenVertex& corner : f.corners) Extend(corner.x, corner.y, &extent);
    const PixelBox pixels = PixelsOf(extent);
    return PixelBox{pixels.x_begin - box_.x_begin, pixels.y_begin - box_.y_begin, pixels.x_end - box_.x_begin,
                    pixels.y_end - box_.y_begin}
        .ClippedTo(drawn);
  };
  std::erase_if(chunk->large, [&](const LargeFace& f) { return box_of(f).empty(); });
  SortByTile(
      static_cast<int>(chunk->large.size()), tiles_across_, num_tiles, [&](int i) { return box_of(chunk->large[i]); },
      &chunk->large_begin, &chunk->large_entries);
}

void VisibilityBuffer::DrawTile(int index) {
  const int x = index % tiles_across_ * kTileWidth, y = index / tiles_across_ * kTileHeight;
  const int width = std::min(kTileWidth, box_.width() - x), height = std::min(kTileHeight, box_.height() - y);
  int num_entries = 0;
  for (const Chunk& chunk : drawing_->chunks) {
    num_entries += chunk.small_begin[index + 1] - chunk.small_begin[index];
    num_entries += chunk.large_begin[index + 1] - chunk.large_begin[index];
  }
  size_t to = size_t(y) * box_.width() + x;
  if (num_entries == 0) {
    for (int row = 0; row < height; ++row, to += box_.width()) {
      std::fill_n(face_.get() + to, width, -1);
      std::fill_n(nearness_.get() + to, width, -std::numeric_limits<float>::infinity());
    }
    return;
  }
  raster_internal::Tile tile;
  tile.x = x, tile.y = y;
  raster_internal::ClearTile(&tile);
  for (const Chunk& chunk : drawing_->chunks) {
    raster_internal::DrawSmallFaces(chunk.small, chunk.small_entries.data() + chunk.small_begin[index],
                                    chunk.small_begin[index + 1] - chunk.small_begin[index], &tile);
  }
  for (const Chunk& chunk : drawing_->chunks) {
    raster_internal::DrawLargeFaces(chunk.large.data(), chunk.large_entries.data() + chunk.large_begin[index],
                                    chunk.large_begin[index + 1] - chunk.large_begin[index], DrawnBox(),
                                    options_.cull_back_faces, &tile);
  }
  for (int row = 0; row < height; ++row, to += box_.width()) {
    std::copy_n(tile.face + row * kTileWidth, width, face_.get() + to);
    std::copy_n(tile.nearness + row * kTileWidth, width, nearness_.get() + to);
  }
}

void VisibilityBuffer::Render(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera,
                              const VisibilityOptions& options) {
  box_ = {};
  BODYLOOM_CHECK(camera.width > 0 && camera.height > 0 && camera.width < kGuardBandPx && camera.height < kGuardBandPx,
                 "visibility buffer: image size is ", camera.width, "x", camera.height,
                 ", expected positive and below ", kGuardBandPx);
  BODYLOOM_CHECK(options.near_m >= Camera::kMinDepth, "visibility buffer: near plane at ", options.near_m,
                 " m, expected at least ", Camera::kMinDepth, " m");
  BODYLOOM_CHECK(options.num_threads >= 1, "visibility buffer: ", options.num_threads, " threads, expected at least 1");
  num_vertices_ = static_cast<int>(vertices.rows());
  BODYLOOM_CHECK(raster_internal::AllInRange(faces.data(), faces.size(), num_vertices_),
                 "visibility buffer: faces name vertices ", faces.minCoeff(), "..", faces.maxCoeff(), ", expected 0..",
                 num_vertices_ - 1);
  camera_ = camera;
  options_ = options;
  is_linear_ = camera.model == CameraModel::kWeakPerspective || !camera.HasDistortion();

  if (drawing_ == nullptr) drawing_ = std::make_unique<Drawing>();
  const size_t room = static_cast<size_t>(num_vertices_) + kLanes;  // kernels write whole vectors
  projected_.resize(room), drawing_->vertices.resize(room);
  drawing_->screen = {projected_.data(), drawing_->vertices.data()};
  const int vertex_chunks = DivideUp(num_vertices_, kVerticesAChunk);
  drawing_->extents.assign(vertex_chunks, {});
  RunPhases(options.num_threads,
            {{[&] { return vertex_chunks; }, [&](int i) { ProjectChunk(vertices, i); }},
             {[&] { return 1; }, [&](int) { PrepareFaces(vertices, faces); }},
             {[&] { return static_cast<int>(drawing_->chunks.size()); }, [&](int i) { SetUpChunk(faces, i); }},
             {[&] { return tiles_across_ * tiles_down_; }, [&](int i) { DrawTile(i); }}});
}

double VisibilityBuffer::DepthAt(int x, int y) const {
  if (FaceAt(x, y) < 0) return std::numeric_limits<double>::infinity();
  const double nearness = nearness_[box_.IndexOf(x, y)];
  return camera_.model == CameraModel::kPinhole ? 1 / nearness : -nearness;
}

bool VisibilityBuffer::IsVisible(const Vector3d& point, double tolerance_m) const {
  Eigen::Vector2d pixel;
  if (!camera_.Project(point, &pixel)) return false;
  const double x = std::floor(pixel.x() + 0.5), y = std::floor(pixel.y() + 0.5);
  if (!(x >= 0 && x < camera_.width && y >= 0 && y < camera_.height)) return false;
  return DepthAt(static_cast<int>(x), static_cast<int>(y)) >= point.z() - tolerance_m;
}

}  // namespace bodyloom
