// SPDX-License-Identifier: Apache-2.0
#include "render/view/shaded_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "render/raster/raster_simd.h"
#include "render/raster/visibility_buffer.h"
#include "render/view/shade_simd.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Nearness of a point step_m further away.
float FurtherBy(float step_m, float nearness, const Camera& camera) {
  return camera.model == CameraModel::kPinhole ? nearness / (1 + step_m * nearness) : nearness - step_m;
}

/// Interpolates vertex normals in the face at a sample, linearly on the screen: within one face of a body the
/// difference to perspective-correct interpolation is invisible. For one thread; the arrays are borrowed.
class NormalSampler {
 public:
  NormalSampler(const MatrixX3i& faces, const MatrixX3f& normals, const MatrixX2d& pixels)
      : faces_(faces), normals_(normals), pixels_(pixels) {}

  /// Interpolated normal, not of unit length.
  Vector3f At(int face, double x, double y) {
    if (face != face_) Prepare(face);
    const Vector2f at = (Vector2d(x, y) - origin_).cast<float>();
    const float b = std::clamp(row_b_.dot(at), 0.0F, 1.0F), c = std::clamp(row_c_.dot(at), 0.0F, 1.0F);
    return corner_[0] + b * (corner_[1] - corner_[0]) + c * (corner_[2] - corner_[0]);
  }

 private:
  void Prepare(int face) {
    face_ = face;
    for (int i = 0; i < 3; ++i) corner_[i] = normals_.row(faces_(face, i)).transpose();
    origin_ = pixels_.row(faces_(face, 0)).transpose();
    const Vector2d u = pixels_.row(faces_(face, 1)).transpose() - origin_;
    const Vector2d v = pixels_.row(faces_(face, 2)).transpose() - origin_;
    const double area = u.x() * v.y() - u.y() * v.x();
    const double scale = std::abs(area) > 1e-9 ? 1 / area : 0;
    row_b_ = (scale * Vector2d(v.y(), -v.x())).cast<float>();
    row_c_ = (scale * Vector2d(-u.y(), u.x())).cast<float>();
  }

  const MatrixX3i& faces_;
  const MatrixX3f& normals_;
  const MatrixX2d& pixels_;
  int face_ = -1;
  std::array<Vector3f, 3> corner_ = {Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero()};
  Vector2d origin_ = Vector2d::Zero();
  Vector2f row_b_ = Vector2f::Zero(), row_c_ = Vector2f::Zero();
};

/// Finds contour samples: those with background, or surface at least 4 cm further away, within `radius` samples. The
/// line lies on the nearer side.
class ContourFinder {
 public:
  ContourFinder(const VisibilityBuffer& buffer, const Camera& camera, int radius)
      : buffer_(buffer),
        camera_(camera),
        radius_(radius),
        nothing_(buffer.box().width(), -std::numeric_limits<float>::infinity()) {
    const int diagonal = std::max(1, static_cast<int>(std::lround(radius * 0.7071)));
    offsets_ = {{{radius, 0},
                 {-radius, 0},
                 {0, radius},
                 {0, -radius},
                 {diagonal, diagonal},
                 {diagonal, -diagonal},
                 {-diagonal, diagonal},
                 {-diagonal, -diagonal}}};
  }

  /// Sets mask[i] ≠ 0 if the sample (begin + i, y) of the box's row y lies on the line. Undefined on the background.
  void FindRow(int y, int begin, int end, int8_t* mask) const {
    const PixelBox& box = buffer_.box();
    // Columns whose neighbours all lie in the box.
    const int inner_begin = std::clamp(box.x_begin + radius_, begin, end);
    const int inner_end = std::clamp(box.x_end - radius_, inner_begin, end);
    for (int x = begin; x < inner_begin; ++x) mask[x - begin] = IsContour(x, y) ? -1 : 0;
    for (int x = inner_end; x < end; ++x) mask[x - begin] = IsContour(x, y) ? -1 : 0;
    shade_internal::ContourRow row;
    row.here = RowAt(y) + (inner_begin - box.x_begin);
    row.count = inner_end - inner_begin;
    for (size_t k = 0; k < offsets_.size(); ++k) {
      const int j = std::clamp(y + offsets_[k][1], 0, camera_.height - 1);  // no contour at the image's border
      row.neighbours[k] = RowAt(j) + (inner_begin + offsets_[k][0] - box.x_begin);
    }
    if (row.count > 0) {
      shade_internal::FindContour(row, kStep_m, camera_.model == CameraModel::kWeakPerspective,
                                  mask + inner_begin - begin);
    }
  }

 private:
  static constexpr float kStep_m = 0.04F;

  [[nodiscard]] const float* RowAt(int y) const {
    const PixelBox& box = buffer_.box();
    if (y < box.y_begin || y >= box.y_end) return nothing_.data();
    return buffer_.nearness().data() + box.IndexOf(box.x_begin, y);
  }

  [[nodiscard]] bool IsContour(int x, int y) const {
    const float here = RowAt(y)[x - buffer_.box().x_begin];
    const float limit = FurtherBy(kStep_m, here, camera_);
    return std::any_of(offsets_.begin(), offsets_.end(), [&](const auto& d) {
      const int i = std::clamp(x + d[0], 0, camera_.width - 1);
      const int j = std::clamp(y + d[1], 0, camera_.height - 1);
      return !buffer_.box().Contains(i, j) || buffer_.nearness()[buffer_.box().IndexOf(i, j)] < limit;
    });
  }

  const VisibilityBuffer& buffer_;
  const Camera& camera_;
  int radius_;
  std::vector<float> nothing_;
  std::array<std::array<int, 2>, 8> offsets_;
};

/// Points of a row of pixels at which shading is computed, each for a share of its pixel.
struct ShadingPoints {
  int size = 0;
  std::vector<float> nx, ny, nz, blue, green, red;
  std::vector<int> column;
  std::vector<float> cover;  ///< opacity × share of the pixel
  std::vector<Colour> ink;   ///< colour of the contour blended in
  std::vector<uint8_t> on_contour;
  explicit ShadingPoints(int capacity) : column(capacity), cover(capacity), ink(capacity), on_contour(capacity) {
    for (auto* values : {&nx, &ny, &nz, &blue, &green, &red}) values->resize(capacity + shade_internal::kLanes);
  }
};

class MeshPainter {
 public:
  MeshPainter(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, const MeshStyle& style,
              VisibilityBuffer* buffer, VertexNormalsOfMesh* normals)
      : faces_(faces), style_(style), n_(style.samples), fine_(ScaledCamera(camera, style.samples)), buffer_(*buffer) {
    buffer->Render(vertices, faces, fine_, {.num_threads = style.num_threads});
    if (!buffer_.box().empty()) normals_ = &normals->Compute(vertices, faces);
    pixels_.resize(vertices.rows(), 2);
    for (int v = 0; v < vertices.rows(); ++v) {
      Vector2d pixel = Vector2d::Zero();
      fine_.Project(vertices.row(v).transpose(), &pixel);
      pixels_.row(v) = pixel.transpose();
    }
    const int radius = static_cast<int>(std::lround(style.contour_px * n_));
    if (radius > 0) contour_.emplace(buffer_, fine_, radius);
    const PixelBox& box = buffer_.box();
    box_ = {box.x_begin / n_, box.y_begin / n_, (box.x_end + n_ - 1) / n_, (box.y_end + n_ - 1) / n_};
  }

  [[nodiscard]] const PixelBox& box() const { return box_; }

  void DrawRows(int y_begin, int y_end, Image* image) const {
    Scratch scratch(box_.width(), n_);
    NormalSampler normals(faces_, *normals_, pixels_);
    // The number of samples as a template argument: nearly half of the time is spent in loops over them.
    const auto draw_row = n_ == 1   ? &MeshPainter::DrawRow<1>
                          : n_ == 2 ? &MeshPainter::DrawRow<2>
                          : n_ == 3 ? &MeshPainter::DrawRow<3>
                                    : &MeshPainter::DrawRow<0>;
    for (int y = y_begin; y < y_end; ++y) (this->*draw_row)(y, &normals, &scratch, image);
  }

 private:
  struct Scratch {
    ShadingPoints points;
    std::vector<int8_t> mask;  ///< n rows of n·width samples
    std::vector<float> cover, blue, green, red;
    Scratch(int width, int n) : points(width * n * n), mask(size_t(width) * n * n) {
      for (auto* values : {&cover, &blue, &green, &red}) values->resize(width + shade_internal::kLanes);
    }
  };

  /// The samples of one pixel, row by row; −1 outside the box.
  struct PixelSamples {
    std::array<int, 64> face;
    std::array<uint8_t, 64> on_contour;
    bool any = false;
    bool is_smooth = true;  ///< all covered, one colour, no line, no step in depth
  };

  /// Columns of the box, [begin, end), outside of which the pixel row is background.
  void FindSpan(int y, int* begin, int* end) const {
    const PixelBox& box = buffer_.box();
    *begin = box.x_end, *end = box.x_begin;
    for (int j = std::max(y * n_, box.y_begin); j < std::min((y + 1) * n_, box.y_end); ++j) {
      const CoveredSpan span = FindCoveredSpan(&buffer_.faces()[box.IndexOf(box.x_begin, j)], box.width());
      if (span.begin == span.end) continue;
      *begin = std::min(*begin, box.x_begin + span.begin), *end = std::max(*end, box.x_begin + span.end);
    }
  }

  /// `mask` starts at column mask_begin of the box and has rows of n·width bytes.
  template <int kSamples>
  void ReadSamples(int x, int y, int mask_begin, const int8_t* mask, PixelSamples* samples) const {
    const int n = kSamples > 0 ? kSamples : n_;
    const PixelBox& box = buffer_.box();
    const bool is_inside = box.Contains(x * n, y * n) && box.Contains(x * n + n - 1, y * n + n - 1);
    float nearest = -std::numeric_limits<float>::infinity(), furthest = -nearest;
    int all = -1, any_missing = 0, lines = 0;
    for (int j = 0, s = 0; j < n; ++j) {
      const size_t row = is_inside ? box.IndexOf(x * n, y * n + j) : 0;
      const int8_t* mask_row = mask + size_t(j) * box_.width() * n + (x * n - mask_begin);
      for (int i = 0; i < n; ++i, ++s) {
        size_t at = row + i;
        if (!is_inside) {
          if (!box.Contains(x * n + i, y * n + j)) {
            samples->face[s] = any_missing = -1;
            continue;
          }
          at = box.IndexOf(x * n + i, y * n + j);
        }
        const int face = buffer_.faces()[at];
        const float nearness = buffer_.nearness()[at];
        samples->face[s] = face;
        samples->on_contour[s] = contour_ && face >= 0 && mask_row[i] != 0;
        lines |= samples->on_contour[s];
        all &= face, any_missing |= face;
        nearest = std::max(nearest, nearness), furthest = std::min(furthest, nearness);
      }
    }
    constexpr float kStep_m = 0.01F;
    samples->any = all != -1;
    samples->is_smooth = any_missing >= 0 && lines == 0 && furthest >= FurtherBy(kStep_m, nearest, fine_);
    for (int s = 1; s < n * n && samples->is_smooth && !style_.face_colours.empty(); ++s) {
      samples->is_smooth =
          samples->face[s] == samples->face[0] || ColourOf(samples->face[s]) == ColourOf(samples->face[0]);
    }
  }

  [[nodiscard]] const Colour& ColourOf(int face) const {
    return style_.face_colours.empty() ? style_.colour : style_.face_colours[face];
  }

  void AddPoint(int column, int face, double x, double y, bool on_contour, float share, NormalSampler* normals,
                ShadingPoints* points) const {
    const int i = points->size++;
    const Vector3f normal = normals->At(face, x, y);
    points->nx[i] = normal.x(), points->ny[i] = normal.y(), points->nz[i] = normal.z();
    const Colour& c = ColourOf(face);
    points->blue[i] = c.blue, points->green[i] = c.green, points->red[i] = c.red;
    points->column[i] = column;
    points->on_contour[i] = on_contour;
    points->ink[i] = c;
    const double alpha = on_contour ? std::max(style_.alpha, style_.contour_alpha) : style_.alpha;
    points->cover[i] = static_cast<float>(alpha) * share;
  }

  template <int kSamples>
  void DrawRow(int y, NormalSampler* normals, Scratch* scratch, Image* image) const {
    int fine_begin, fine_end;
    FindSpan(y, &fine_begin, &fine_end);
    if (fine_begin >= fine_end) return;
    const PixelBox& box = buffer_.box();
    for (int j = 0; j < n_ && contour_; ++j) {
      if (y * n_ + j < box.y_begin || y * n_ + j >= box.y_end) continue;
      contour_->FindRow(y * n_ + j, fine_begin, fine_end, &scratch->mask[size_t(j) * box_.width() * n_]);
    }
    const int begin = fine_begin / n_, end = (fine_end + n_ - 1) / n_;
    ShadingPoints& points = scratch->points;
    points.size = 0;
    const float share = 1.0F / static_cast<float>(n_ * n_);
    PixelSamples samples;
    for (int x = begin; x < end; ++x) {
      ReadSamples<kSamples>(x, y, fine_begin, scratch->mask.data(), &samples);
      if (!samples.any) continue;
      if (samples.is_smooth) {
        const double middle = 0.5 * (n_ - 1);
        AddPoint(x - begin, samples.face[0], x * n_ + middle, y * n_ + middle, false, 1, normals, &points);
        continue;
      }
      for (int s = 0; s < n_ * n_; ++s) {
        if (samples.face[s] < 0) continue;
        const int sample_x = x * n_ + s % n_, sample_y = y * n_ + s / n_;
        AddPoint(x - begin, samples.face[s], sample_x, sample_y, samples.on_contour[s], share, normals, &points);
      }
    }
    shade_internal::ShadePixels({points.nx.data(), points.ny.data(), points.nz.data(), points.blue.data(),
                                 points.green.data(), points.red.data(), points.size});
    for (auto* values : {&scratch->cover, &scratch->blue, &scratch->green, &scratch->red}) {
      std::fill_n(values->begin(), end - begin, 0.0F);
    }
    const auto ink = static_cast<float>(style_.contour_alpha);
    for (int i = 0; i < points.size; ++i) {
      const int x = points.column[i];
      const float cover = points.cover[i];
      scratch->cover[x] += cover;
      const float keep = points.on_contour[i] ? cover * (1 - ink) : cover;
      const float line = points.on_contour[i] ? cover * ink * 0.22F : 0;
      scratch->blue[x] += keep * points.blue[i] + line * points.ink[i].blue;
      scratch->green[x] += keep * points.green[i] + line * points.ink[i].green;
      scratch->red[x] += keep * points.red[i] + line * points.ink[i].red;
    }
    shade_internal::BlendPixels(
        {scratch->cover.data(), scratch->blue.data(), scratch->green.data(), scratch->red.data(), end - begin},
        image->pixel(begin, y));
  }

  const MatrixX3i& faces_;
  const MeshStyle& style_;
  int n_;
  Camera fine_;
  const VisibilityBuffer& buffer_;
  const MatrixX3f* normals_ = nullptr;  ///< null: mesh not in view
  MatrixX2d pixels_;
  std::optional<ContourFinder> contour_;
  PixelBox box_;
};

}  // namespace

void MeshDrawer::Draw(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, const MeshStyle& style,
                      Image* image) {
  BODYLOOM_CHECK(image->width == camera.width && image->height == camera.height, "overlay: the image is ", image->width,
                 "x", image->height, ", the camera ", camera.width, "x", camera.height);
  BODYLOOM_CHECK(style.face_colours.empty() || static_cast<Eigen::Index>(style.face_colours.size()) == faces.rows(),
                 "overlay: ", style.face_colours.size(), " face colours for ", faces.rows(), " faces");
  BODYLOOM_CHECK(style.samples >= 1 && style.samples <= 8, "overlay: ", style.samples, " samples, expected 1..8");
  const MeshPainter painter(vertices, faces, camera, style, &buffer_, &normals_);
  constexpr int kRowsATask = 8;
  const PixelBox& box = painter.box();
  ParallelFor((box.height() + kRowsATask - 1) / kRowsATask, style.num_threads, [&](int task) {
    const int begin = box.y_begin + task * kRowsATask;
    painter.DrawRows(begin, std::min(box.y_end, begin + kRowsATask), image);
  });
}

void DrawMesh(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, const MeshStyle& style,
              Image* image) {
  MeshDrawer().Draw(vertices, faces, camera, style, image);
}

}  // namespace bodyloom
