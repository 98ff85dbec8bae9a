// SPDX-License-Identifier: Apache-2.0
#include "render/shaded_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/check.h"
#include "render/view_camera.h"
#include "render/visibility_buffer.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Light that a surface with this unit normal sends to the eye, 0 dark … 1 full colour … above 1 highlight. Camera
/// frame: the eye looks along +z.
struct Light {
  float diffuse, highlight;
};
Light Shade(const Vector3f& n) {
  static const Vector3f kKey = Vector3f(-0.45f, -0.65f, -0.62f).normalized();  // from the upper left, behind the viewer
  static const Vector3f kFill = Vector3f(0.75f, -0.05f, -0.65f).normalized();
  static const Vector3f kHalfway = (kKey + Vector3f(0, 0, -1)).normalized();
  const float key = std::max(0.0f, 0.5f + 0.5f * n.dot(kKey));  // wraps round: no hard terminator
  const float fill = std::max(0.0f, n.dot(kFill));
  const float sky = 0.5f - 0.5f * n.y();
  const float edge = 1 - std::min(1.0f, std::abs(n.z()));
  const float rim = edge * edge * edge;
  float spark = std::max(0.0f, n.dot(kHalfway));
  for (int i = 0; i < 5; ++i) spark *= spark;  // to the power of 32
  return {0.22f + 0.72f * key * key + 0.13f * fill + 0.12f * sky, 0.10f * spark + 0.16f * rim * sky};
}

/// Interpolates vertex normals across the face under a sample. Linear on the screen: inside one face of a body that
/// differs from the perspective-correct value by less than shading can show.
class NormalSampler {
 public:
  NormalSampler(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera)
      : faces_(faces), normals_(VertexNormals(vertices, faces).cast<float>()), pixels_(vertices.rows(), 2) {
    for (int v = 0; v < vertices.rows(); ++v) {
      Vector2d pixel = Vector2d::Zero();
      camera.Project(vertices.row(v).transpose(), &pixel);
      pixels_.row(v) = pixel.transpose();
    }
  }

  Vector3f At(int face, double x, double y) {
    if (face != face_) Prepare(face);
    const auto b = static_cast<float>(std::clamp(row_b_.dot(Vector2d(x, y) - origin_), 0.0, 1.0));
    const auto c = static_cast<float>(std::clamp(row_c_.dot(Vector2d(x, y) - origin_), 0.0, 1.0));
    return (corner_[0] + b * (corner_[1] - corner_[0]) + c * (corner_[2] - corner_[0])).normalized();
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
    row_b_ = scale * Vector2d(v.y(), -v.x());
    row_c_ = scale * Vector2d(-u.y(), u.x());
  }

  const MatrixX3i& faces_;
  MatrixX3f normals_;
  MatrixX2d pixels_;
  int face_ = -1;
  std::array<Vector3f, 3> corner_ = {Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero()};
  Vector2d origin_ = Vector2d::Zero(), row_b_ = Vector2d::Zero(), row_c_ = Vector2d::Zero();
};

/// Finds the samples where the surface ends: the background, or something at least 4 cm further away, begins within
/// `radius` samples. The line lies on the nearer side.
class OutlineFinder {
 public:
  OutlineFinder(const VisibilityBuffer& buffer, const Camera& camera, int radius)
      : buffer_(buffer), camera_(camera), inner_(buffer.box().GrownBy(-radius)) {
    const int diagonal = std::max(1, static_cast<int>(std::lround(radius * 0.7071)));
    offsets_ = {{{radius, 0},
                 {-radius, 0},
                 {0, radius},
                 {0, -radius},
                 {diagonal, diagonal},
                 {diagonal, -diagonal},
                 {-diagonal, diagonal},
                 {-diagonal, -diagonal}}};
    for (size_t k = 0; k < offsets_.size(); ++k)
      steps_[k] = ptrdiff_t(offsets_[k][1]) * buffer.box().width() + offsets_[k][0];
  }

  [[nodiscard]] bool IsOutline(int x, int y) const {
    constexpr float kStep_m = 0.04f;
    const size_t index = buffer_.box().IndexOf(x, y);
    const float* here = buffer_.nearness().data() + index;
    const float limit = camera_.model == CameraModel::kPinhole ? *here / (1 + kStep_m * *here) : *here - kStep_m;
    if (inner_.Contains(x, y)) {
      return std::any_of(steps_.begin(), steps_.end(), [&](ptrdiff_t step) { return here[step] < limit; });
    }
    return std::any_of(offsets_.begin(), offsets_.end(), [&](const auto& d) {
      const int i = std::clamp(x + d[0], 0, camera_.width - 1);  // the border of the image ends no surface
      const int j = std::clamp(y + d[1], 0, camera_.height - 1);
      return !buffer_.box().Contains(i, j) || buffer_.nearness()[buffer_.box().IndexOf(i, j)] < limit;
    });
  }

 private:
  const VisibilityBuffer& buffer_;
  const Camera& camera_;
  PixelBox inner_;  ///< where no neighbour leaves the box
  std::array<std::array<int, 2>, 8> offsets_;
  std::array<ptrdiff_t, 8> steps_;
};

}  // namespace

MatrixX3d VertexNormals(const MatrixX3d& vertices, const MatrixX3i& faces) {
  MatrixX3d normals = MatrixX3d::Zero(vertices.rows(), 3);
  for (int f = 0; f < faces.rows(); ++f) {
    const Vector3d a = vertices.row(faces(f, 0)), b = vertices.row(faces(f, 1)), c = vertices.row(faces(f, 2));
    const Vector3d twice_area = (b - a).cross(c - a);
    for (int i = 0; i < 3; ++i) normals.row(faces(f, i)) += twice_area.transpose();
  }
  for (int v = 0; v < normals.rows(); ++v) {
    const double norm = normals.row(v).norm();
    if (norm > 0) normals.row(v) /= norm;
  }
  return normals;
}

void DrawMesh(const MatrixX3d& vertices, const MatrixX3i& faces, const Camera& camera, const MeshStyle& style,
              Image* image) {
  BODYLOOM_CHECK(image->width == camera.width && image->height == camera.height, "overlay: the image is ", image->width,
                 "x", image->height, ", the camera ", camera.width, "x", camera.height);
  BODYLOOM_CHECK(style.face_colours.empty() || static_cast<Eigen::Index>(style.face_colours.size()) == faces.rows(),
                 "overlay: ", style.face_colours.size(), " face colours for ", faces.rows(), " faces");
  BODYLOOM_CHECK(style.samples >= 1 && style.samples <= 8, "overlay: ", style.samples, " samples, expected 1..8");
  const int n = style.samples;
  const Camera fine = ScaledCamera(camera, n);
  VisibilityBuffer buffer;
  buffer.Render(vertices, faces, fine);
  if (buffer.box().empty()) return;
  NormalSampler normals(vertices, faces, fine);
  const int radius = static_cast<int>(std::lround(style.outline_px * n));
  const OutlineFinder outline(buffer, fine, radius);
  const PixelBox box{buffer.box().x_begin / n, buffer.box().y_begin / n, (buffer.box().x_end + n - 1) / n,
                     (buffer.box().y_end + n - 1) / n};
  const float per_sample = 1.0f / static_cast<float>(n * n);

  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      Vector3f sum = Vector3f::Zero();  // premultiplied, blue green red
      float cover = 0;
      for (int j = y * n; j < (y + 1) * n; ++j) {
        for (int i = x * n; i < (x + 1) * n; ++i) {
          const int face = buffer.FaceAt(i, j);
          if (face < 0) continue;
          const Colour& c = style.face_colours.empty() ? style.colour : style.face_colours[face];
          const Light light = Shade(normals.At(face, i, j));
          Vector3f colour =
              Vector3f(c.blue, c.green, c.red) * light.diffuse + Vector3f::Constant(255 * light.highlight);
          auto alpha = static_cast<float>(style.alpha);
          if (radius > 0 && outline.IsOutline(i, j)) {
            const auto ink = static_cast<float>(style.outline_alpha);
            colour = (1 - ink) * colour + ink * 0.22f * Vector3f(c.blue, c.green, c.red);
            alpha = std::max(alpha, ink);
          }
          sum += alpha * colour.cwiseMin(255.0f);
          cover += alpha;
        }
      }
      if (cover == 0) continue;
      uint8_t* p = image->pixel(x, y);
      for (int k = 0; k < 3; ++k) {
        p[k] = static_cast<uint8_t>(
            std::clamp(p[k] * (1 - cover * per_sample) + sum[k] * per_sample + 0.5f, 0.0f, 255.0f));
      }
    }
  }
}

}  // namespace bodyloom
