// SPDX-License-Identifier: Apache-2.0
#include "render/visibility_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kSubpixels = 256;
constexpr double kGuardBandPx = 1 << 21;  // 2^29 subpixels: sums of two products of differences stay below 2^62

/// A convex polygon of at most 3 + 5 corners in the camera frame.
struct Polygon {
  std::array<Vector3d, 8> corners;
  int size = 0;
};

/// Keeps the part of the polygon with plane · (x, y, z, 1) >= 0. A crossing is always computed from the corner inside
/// to the corner outside, so the two faces of a shared edge get the same point.
void ClipAtPlane(const Vector4d& plane, Polygon* polygon) {
  Polygon kept;
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

/// The four planes inside of which |x_px| and |y_px| stay below the guard band (less a pixel for rounding).
std::array<Vector4d, 4> GuardPlanes(const Camera& camera) {
  constexpr double kLimit = kGuardBandPx - 1;
  if (camera.model == CameraModel::kWeakPerspective) {
    const double s = camera.scale, x = s * camera.tx + camera.cx, y = s * camera.ty + camera.cy;
    return {Vector4d(s, 0, 0, kLimit + x), Vector4d(-s, 0, 0, kLimit - x), Vector4d(0, s, 0, kLimit + y),
            Vector4d(0, -s, 0, kLimit - y)};
  }
  return {Vector4d(camera.fx, 0, camera.cx + kLimit, 0), Vector4d(-camera.fx, 0, kLimit - camera.cx, 0),
          Vector4d(0, camera.fy, camera.cy + kLimit, 0), Vector4d(0, -camera.fy, kLimit - camera.cy, 0)};
}

int FloorDivide(int64_t a, int64_t b) { return static_cast<int>(a >= 0 ? a / b : -((-a + b - 1) / b)); }

}  // namespace

VisibilityBuffer::ScreenVertex VisibilityBuffer::ToScreen(const Vector3d& point) const {
  ScreenVertex result;
  Eigen::Vector2d pixel;
  if (is_plain_pinhole_) {
    if (!(point.z() >= options_.near_m)) return result;
    result.nearness = 1 / point.z();
    pixel = {camera_.fx * point.x() * result.nearness + camera_.cx,
             camera_.fy * point.y() * result.nearness + camera_.cy};
  } else if (camera_.model == CameraModel::kPinhole) {
    if (!(point.z() >= options_.near_m) || !camera_.Project(point, &pixel)) return result;
    result.nearness = 1 / point.z();
  } else {
    camera_.Project(point, &pixel);
    result.nearness = -point.z();
  }
  if (!(pixel.cwiseAbs().maxCoeff() < kGuardBandPx)) return result;
  result.x = static_cast<int32_t>(std::floor(pixel.x() * kSubpixels + 0.5));
  result.y = static_cast<int32_t>(std::floor(pixel.y() * kSubpixels + 0.5));
  result.usable = true;
  return result;
}

void VisibilityBuffer::FindBox(int num_vertices) {
  const PixelBox image{0, 0, camera_.width, camera_.height};
  int32_t x_min = std::numeric_limits<int32_t>::max(), x_max = std::numeric_limits<int32_t>::min();
  int32_t y_min = x_min, y_max = x_max;
  for (int v = 0; v < num_vertices; ++v) {
    const ScreenVertex& s = screen_[v];
    if (!s.usable) {  // a face that is clipped may reach anywhere
      box_ = image;
      return;
    }
    x_min = std::min(x_min, s.x), x_max = std::max(x_max, s.x);
    y_min = std::min(y_min, s.y), y_max = std::max(y_max, s.y);
  }
  if (num_vertices == 0) {
    box_ = {};
    return;
  }
  const PixelBox mesh{FloorDivide(x_min + kSubpixels - 1, kSubpixels), FloorDivide(y_min + kSubpixels - 1, kSubpixels),
                      FloorDivide(x_max, kSubpixels) + 1, FloorDivide(y_max, kSubpixels) + 1};
  box_ = mesh.ClippedTo(image);
  if (box_.empty()) box_ = {};
}

void VisibilityBuffer::Render(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera,
                              const VisibilityOptions& options) {
  BODYLOOM_CHECK(camera.width > 0 && camera.height > 0 && camera.width < kGuardBandPx && camera.height < kGuardBandPx,
                 "visibility buffer: image size is ", camera.width, "x", camera.height,
                 ", expected positive and below ", kGuardBandPx);
  BODYLOOM_CHECK(options.near_m >= Camera::kMinDepth, "visibility buffer: near plane at ", options.near_m,
                 " m, expected at least ", Camera::kMinDepth, " m");
  BODYLOOM_CHECK(vertices.allFinite(), "visibility buffer: vertices hold NaN or infinite values");
  const int V = static_cast<int>(vertices.rows()), F = static_cast<int>(faces.rows());
  if (F > 0) {
    BODYLOOM_CHECK(faces.minCoeff() >= 0 && faces.maxCoeff() < V, "visibility buffer: faces name vertices ",
                   faces.minCoeff(), "..", faces.maxCoeff(), ", expected 0..", V - 1);
  }
  camera_ = camera;
  options_ = options;
  is_plain_pinhole_ = camera.model == CameraModel::kPinhole && !camera.HasDistortion();

  screen_.resize(V);
  for (int v = 0; v < V; ++v) screen_[v] = ToScreen(vertices.row(v).transpose());
  FindBox(F > 0 ? V : 0);
  face_.assign(box_.area(), -1);
  nearness_.assign(box_.area(), -std::numeric_limits<float>::infinity());
  if (box_.empty()) return;

  for (int f = 0; f < F; ++f) {
    const ScreenVertex &a = screen_[faces(f, 0)], &b = screen_[faces(f, 1)], &c = screen_[faces(f, 2)];
    if (a.usable && b.usable && c.usable) {
      DrawFace(a, b, c, f);
    } else {
      DrawClipped(vertices, faces, f);
    }
  }
}

void VisibilityBuffer::DrawFace(const ScreenVertex& a, ScreenVertex b, ScreenVertex c, int face) {
  int64_t area = int64_t(b.x - a.x) * (c.y - a.y) - int64_t(b.y - a.y) * (c.x - a.x);
  if (area == 0 || (area > 0 && options_.cull_back_faces)) return;  // y is down: counter-clockwise is negative
  if (area < 0) {
    std::swap(b, c);
    area = -area;
  }
  const int x_begin = std::max(box_.x_begin, FloorDivide(std::min({a.x, b.x, c.x}) + kSubpixels - 1, kSubpixels));
  const int x_end = std::min(box_.x_end, FloorDivide(std::max({a.x, b.x, c.x}), kSubpixels) + 1);
  const int y_begin = std::max(box_.y_begin, FloorDivide(std::min({a.y, b.y, c.y}) + kSubpixels - 1, kSubpixels));
  const int y_end = std::min(box_.y_end, FloorDivide(std::max({a.y, b.y, c.y}), kSubpixels) + 1);
  if (x_begin >= x_end || y_begin >= y_end) return;

  // Edge function of p → q: (q−p) × (pixel−p), positive inside. A pixel on an edge belongs to the face when the edge is
  // a left one (inside lies to the right) or a horizontal top one; otherwise 1 is taken off, so that one sign test
  // does.
  struct Edge {
    int64_t at_row, step_x, step_y, bias;
  };
  const auto edge = [&](const ScreenVertex& p, const ScreenVertex& q) {
    const int64_t dx = q.x - p.x, dy = q.y - p.y;
    const int64_t bias = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
    const int64_t value = dx * (int64_t(y_begin) * kSubpixels - p.y) - dy * (int64_t(x_begin) * kSubpixels - p.x);
    return Edge{value - bias, -dy * kSubpixels, dx * kSubpixels, bias};
  };
  Edge opposite_a = edge(b, c), opposite_b = edge(c, a), opposite_c = edge(a, b);
  const double per_area = 1.0 / static_cast<double>(area);
  const double slope_b = (b.nearness - a.nearness) * per_area, slope_c = (c.nearness - a.nearness) * per_area;

  for (int y = y_begin; y < y_end; ++y) {
    int64_t ea = opposite_a.at_row, eb = opposite_b.at_row, ec = opposite_c.at_row;
    const size_t row = box_.IndexOf(x_begin, y);
    for (int i = 0; i < x_end - x_begin; ++i) {
      if ((ea | eb | ec) >= 0) {
        // A mean of the corners' values weighted by integers: never outside their range, however thin the face.
        const auto nearness = static_cast<float>(a.nearness + static_cast<double>(eb + opposite_b.bias) * slope_b +
                                                 static_cast<double>(ec + opposite_c.bias) * slope_c);
        if (nearness > nearness_[row + i]) {  // faces come in rising order: at a tie the lowest stays
          nearness_[row + i] = nearness;
          face_[row + i] = face;
        }
      }
      ea += opposite_a.step_x, eb += opposite_b.step_x, ec += opposite_c.step_x;
    }
    opposite_a.at_row += opposite_a.step_y, opposite_b.at_row += opposite_b.step_y,
        opposite_c.at_row += opposite_c.step_y;
  }
}

void VisibilityBuffer::DrawClipped(const MatrixX3d& vertices, const MatrixX3i& faces, int face) {
  Polygon polygon;
  polygon.size = 3;
  for (int c = 0; c < 3; ++c) polygon.corners[c] = vertices.row(faces(face, c)).transpose();
  if (camera_.model == CameraModel::kPinhole) {
    // The clipped corner must pass the test z >= near in ToScreen in spite of rounding.
    ClipAtPlane(Vector4d(0, 0, 1, -options_.near_m * (1 + 1e-9)), &polygon);
  }
  if (!camera_.HasDistortion()) {
    for (const Vector4d& plane : GuardPlanes(camera_)) {
      if (polygon.size == 0) return;
      ClipAtPlane(plane, &polygon);
    }
  }
  std::array<ScreenVertex, 8> screen;
  for (int i = 0; i < polygon.size; ++i) {
    screen[i] = ToScreen(polygon.corners[i]);
    if (!screen[i].usable) return;
  }
  for (int i = 2; i < polygon.size; ++i) DrawFace(screen[0], screen[i - 1], screen[i], face);
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
