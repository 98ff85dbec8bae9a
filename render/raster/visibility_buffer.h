// SPDX-License-Identifier: Apache-2.0
/// The visibility buffer, the visible face of a mesh at each pixel and how near it is: one id and one depth a pixel,
/// nothing else. Attributes are resolved afterwards for the pixels that need them (render/raster/resolve_pixels.h,
/// render/raster/visible_points.h).
///
/// - A pixel sees what its centre sees (integer coordinates, geometry/scene/camera.h).
/// - Vertices are projected and rounded to 1/256 px; edge functions are integers with the top-left rule, so that two
///   faces that share an edge never both cover a pixel centre and never leave a hole between them.
/// - The nearest face wins; of faces at exactly the same depth, the one with the lowest index.
/// - Pinhole: 1/z is linear on the screen and is what is compared. Weak perspective: z is. Formula and rounding:
///   render/raster/raster_simd.h.
/// - Faces are clipped in space at the near plane and, should they reach further than 2^21 px, at that guard band.
///   With lens distortion edges are drawn straight between distorted vertices, and a face that after the near clip
///   still has a vertex outside the lens' field of view is not drawn.
/// - Only the box that holds the projected mesh is allocated, cleared and visited.
///
/// Same input, same bytes: for any number of threads and any instruction set. Cost: docs/lab/raster.md.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/image/pixel_box.h"
#include "render/raster/raster_simd.h"

namespace bodyloom {

namespace raster_internal {
struct Box;
struct ScreenExtent;
struct ScreenVertex;
}  // namespace raster_internal

struct VisibilityOptions {
  bool cull_back_faces = true;  ///< faces are counter-clockwise seen from outside
  double near_m = 0.01;         ///< pinhole: nothing nearer than this is seen; at least Camera::kMinDepth
  int num_threads = 1;          ///< at least 1
  bool whole_image = false;     ///< visit every pixel of the image instead of the mesh's box: same result, slower
};

/// Keeps its memory between frames. Not for use by two threads at once.
class VisibilityBuffer {
 public:
  VisibilityBuffer();
  ~VisibilityBuffer();
  VisibilityBuffer(VisibilityBuffer&&) noexcept;
  VisibilityBuffer& operator=(VisibilityBuffer&&) noexcept;

  /// Sees `faces` (F×3, indices into the V×3 vertices in the camera frame, metres) with `camera`. Throws
  /// std::invalid_argument when the camera has no image size, an index is out of range or a vertex is not finite; the
  /// buffer sees nothing then.
  void Render(const MatrixX3d& vertices_in_camera, const MatrixX3i& faces, const Camera& camera,
              const VisibilityOptions& options = {});

  /// The pixels that were visited; everything outside is background.
  [[nodiscard]] const PixelBox& box() const { return box_; }
  /// Face index of each pixel of the box, row-major; −1 is background.
  [[nodiscard]] std::span<const int32_t> faces() const { return {face_.get(), box_.area()}; }
  /// 1/z (pinhole) or −z (weak perspective) of each pixel of the box: larger is nearer; −infinity on the background.
  [[nodiscard]] std::span<const float> nearness() const { return {nearness_.get(), box_.area()}; }

  /// Face seen by any pixel, −1 for background and outside the image.
  [[nodiscard]] int FaceAt(int x, int y) const { return box_.Contains(x, y) ? face_[box_.IndexOf(x, y)] : -1; }
  /// z of what the pixel sees, metres; +infinity for background.
  [[nodiscard]] double DepthAt(int x, int y) const;

  /// True when a point of the camera frame is not hidden: its pixel sees nothing nearer by more than tolerance_m.
  /// Points outside the image or the camera's valid set are not visible.
  [[nodiscard]] bool IsVisible(const Eigen::Vector3d& point_in_camera, double tolerance_m) const;

  /// The vertices last rendered.
  [[nodiscard]] std::span<const ProjectedVertex> vertices() const { return {projected_.data(), size_t(num_vertices_)}; }

 private:
  struct Chunk;
  struct Drawing;
  void ProjectChunk(const MatrixX3d& vertices, int chunk);
  [[nodiscard]] bool ToScreen(const Eigen::Vector3d& point, raster_internal::ScreenVertex* screen) const;
  void PrepareFaces(const MatrixX3d& vertices, const MatrixX3i& faces);
  void ClipFaces(const MatrixX3d& vertices, const MatrixX3i& faces, raster_internal::ScreenExtent* extent);
  void SetUpChunk(const MatrixX3i& faces, int chunk);
  void SortIntoTiles(Chunk* chunk) const;
  void DrawTile(int tile);
  [[nodiscard]] raster_internal::Box DrawnBox() const;

  Camera camera_;
  bool is_linear_ = true;  ///< no lens distortion
  VisibilityOptions options_;
  PixelBox box_;
  std::unique_ptr<int32_t[]> face_;  ///< not cleared before it is written: at 16k that would take as long as drawing
  std::unique_ptr<float[]> nearness_;
  size_t capacity_ = 0;

  int num_vertices_ = 0, tiles_across_ = 0, tiles_down_ = 0;
  std::vector<ProjectedVertex> projected_;
  std::unique_ptr<Drawing> drawing_;
};

}  // namespace bodyloom
