// SPDX-License-Identifier: Apache-2.0
#include "render/texture/texel_visibility.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Values shared by all texels of a face.
struct FaceSight {
  bool looks_here = false;
  Vector3d normal;    ///< unit
  double offset = 0;  ///< normal · x of the plane
  double texels_per_pixel = 0;
};

double TriangleArea(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

class Viewer {
 public:
  Viewer(const UvTexelTable& table, const BodyModel& body, const MatrixX3d& vertices, const Camera& camera,
         const VisibilityBuffer& buffer, const TexelVisibilityOptions& options)
      : table_(table), body_(body), vertices_(vertices), camera_(camera), buffer_(buffer), options_(options) {
    faces_.resize(body.num_faces());
    for (int f = 0; f < body.num_faces(); ++f) Prepare(f);
  }

  [[nodiscard]] TexelVisibility See(size_t i) const {
    const FaceSight& face = faces_[table_.face[i]];
    if (!face.looks_here || table_.in_gutter[i]) return {};
    const auto corners = body_.data().faces.row(table_.face[i]);
    Vector3d point = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) point += double{table_.barycentric[i][k]} * vertices_.row(corners[k]).transpose();
    const double cosine = Cosine(face, point);
    Vector2d pixel;
    if (cosine < options_.min_cosine || cosine <= 0 || !camera_.Project(point, &pixel)) return {};
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double tolerance = options_.bias_m + options_.slope * PixelSize(point) * sine / cosine;
    const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
    if (options_.whole_footprint) {
      for (int j = 0; j < 2; ++j) {
        for (int k = 0; k < 2; ++k) {
          if (!Shows(x + k, y + j, face, point, tolerance)) return {};
        }
      }
    } else if (!Shows(static_cast<int>(std::floor(pixel.x() + 0.5)), static_cast<int>(std::floor(pixel.y() + 0.5)),
                      face, point, tolerance)) {
      return {};
    }
    return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), static_cast<float>(cosine),
            static_cast<float>(face.texels_per_pixel)};
  }

 private:
  [[nodiscard]] bool IsPinhole() const { return camera_.model == CameraModel::kPinhole; }

  /// Size of a pixel at the point's depth, perpendicular to the ray, metres.
  [[nodiscard]] double PixelSize(const Vector3d& point) const {
    return IsPinhole() ? point.z() / std::min(camera_.fx, camera_.fy) : 1 / camera_.scale;
  }

  [[nodiscard]] double Cosine(const FaceSight& face, const Vector3d& point) const {
    return IsPinhole() ? -face.normal.dot(point) / point.norm() : -face.normal.z();
  }

  void Prepare(int f) {
    const auto corners = body_.data().faces.row(f);
    const Vector3d a = vertices_.row(corners[0]).transpose(), b = vertices_.row(corners[1]).transpose(),
                   c = vertices_.row(corners[2]).transpose();
    const Vector3d cross = (b - a).cross(c - a);
    FaceSight& face = faces_[f];
    if (!(cross.norm() > 0)) return;
    face.normal = cross.normalized();
    face.offset = face.normal.dot(a);
    // The side of the plane that faces the camera does not depend on the point.
    face.looks_here = IsPinhole() ? face.offset < 0 : face.normal.z() < 0;
    Vector2d pa, pb, pc;
    if (!face.looks_here || !camera_.Project(a, &pa) || !camera_.Project(b, &pb) || !camera_.Project(c, &pc)) return;
    Vector2d uv[3];
    for (int k = 0; k < 3; ++k) {
      uv[k] = body_.data().vt.row(body_.data().ft(f, k)).transpose().cast<double>();
      uv[k] = uv[k].cwiseProduct(Vector2d(table_.width, table_.height));
    }
    const double pixels = TriangleArea(pa, pb, pc), texels = TriangleArea(uv[0], uv[1], uv[2]);
    face.texels_per_pixel = pixels > 0 ? texels / pixels : 0;
  }

  [[nodiscard]] bool Shows(int x, int y, const FaceSight& face, const Vector3d& point, double tolerance) const {
    if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) return false;
    const double depth = buffer_.DepthAt(x, y);
    if (!std::isfinite(depth)) return false;
    // Depth of the face's plane at that pixel: expected if nothing occludes it.
    const Vector2d ray = camera_.Unproject({x, y});
    double expected = point.z();
    if (IsPinhole()) {
      const double along = face.normal.dot(Vector3d(ray.x(), ray.y(), 1));
      if (along < 0) expected = face.offset / along;
    } else if (face.normal.z() < 0) {
      expected = (face.offset - face.normal.x() * ray.x() - face.normal.y() * ray.y()) / face.normal.z();
    }
    // Near the face's horizon its plane may not intersect the neighbouring pixel's ray.
    if (!(std::abs(expected - point.z()) <= 2 * tolerance)) expected = point.z();
    return std::abs(depth - expected) <= tolerance;
  }

  const UvTexelTable& table_;
  const BodyModel& body_;
  const MatrixX3d& vertices_;
  const Camera& camera_;
  const VisibilityBuffer& buffer_;
  const TexelVisibilityOptions& options_;
  std::vector<FaceSight> faces_;
};

}  // namespace

bool TexelVisibilityOptions::IsValid(std::string* why) const {
  if (!(min_cosine >= 0 && min_cosine < 1) || !(bias_m >= 0) || !(slope >= 0) || std::isinf(bias_m + slope)) {
    *why = Concatenate("min_cosine ", min_cosine, ", bias_m ", bias_m, ", slope ", slope,
                       "; expected [0, 1), and two numbers from 0 on");
    return false;
  }
  return true;
}

std::vector<TexelVisibility> ComputeTexelVisibility(const UvTexelTable& table, const BodyModel& body,
                                                    const MatrixX3d& vertices_in_camera, const Camera& camera,
                                                    const VisibilityBuffer& buffer,
                                                    const TexelVisibilityOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "texel sight: ", why);
  BODYLOOM_CHECK(vertices_in_camera.rows() == body.num_vertices(), "texel sight: ", vertices_in_camera.rows(),
                 " vertices, the body '", body.name(), "' has ", body.num_vertices());
  const Viewer viewer(table, body, vertices_in_camera, camera, buffer, options);
  std::vector<TexelVisibility> sights(table.size());
  for (size_t i = 0; i < table.size(); ++i) sights[i] = viewer.See(i);
  return sights;
}

}  // namespace bodyloom
