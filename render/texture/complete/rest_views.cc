// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/rest_views.h"

#include <algorithm>
#include <cmath>

#include "render/raster/visible_points.h"

namespace bodyloom {
namespace {

constexpr double kMargin = 0.02;        ///< of the images, on every side
constexpr double kSameSurfaceM = 0.01;  ///< points of one line of sight within this distance are the same
constexpr double kFarM = 10;            ///< distance of the body from the cameras

/// Orthographic square camera with x = 0 at its centre; y points down.
Camera RestCamera(const MatrixX3d& vertices) {
  const double top = vertices.col(1).maxCoeff(), bottom = vertices.col(1).minCoeff();
  const double half = std::max((top - bottom) / 2, vertices.col(0).cwiseAbs().maxCoeff());
  Camera camera;
  camera.model = CameraModel::kWeakPerspective;
  camera.width = camera.height = RestViews::kPixels;
  camera.cx = camera.cy = (RestViews::kPixels - 1) / 2.0;
  camera.scale = (1 - 2 * kMargin) * RestViews::kPixels / (2 * half);
  camera.ty = (top + bottom) / 2;
  return camera;
}

int Nearest(double x) { return static_cast<int>(std::lround(x)); }

}  // namespace

RestViews::RestViews(const MatrixX3d& rest_vertices, const MatrixX3i& faces)
    : faces_(faces), camera_(RestCamera(rest_vertices)) {
  views_[0].sign = Eigen::Vector3d(1, -1, -1);  // half a turn about x
  views_[1].sign = Eigen::Vector3d(-1, -1, 1);  // about z
  for (View& view : views_) {
    view.vertices = rest_vertices * view.sign.asDiagonal();
    view.vertices.col(2).array() += kFarM;
    view.buffer.Render(view.vertices, faces, camera_);
  }
}

bool RestViews::Sees(RestSide side, const Eigen::Vector3d& point) const {
  const View& view = Of(side);
  const Eigen::Vector3d there = view.sign.cwiseProduct(point) + Eigen::Vector3d(0, 0, kFarM);
  Eigen::Vector2d pixel;
  if (!camera_.Project(there, &pixel)) return false;
  return std::abs(view.buffer.DepthAt(Nearest(pixel.x()), Nearest(pixel.y())) - there.z()) < kSameSurfaceM;
}

std::optional<RestSide> RestViews::SideOf(const Eigen::Vector3d& point) const {
  if (Sees(RestSide::kFront, point)) return RestSide::kFront;
  if (Sees(RestSide::kBack, point)) return RestSide::kBack;
  return std::nullopt;
}

SurfacePoint RestViews::At(RestSide side, const Eigen::Vector3d& point) const {
  const View& view = Of(side);
  Eigen::Vector2d pixel;
  if (!camera_.Project(view.sign.cwiseProduct(point), &pixel)) return {};
  const int face = view.buffer.FaceAt(Nearest(pixel.x()), Nearest(pixel.y()));
  if (face < 0) return {};
  return {face, BarycentricAtPixel(view.vertices, faces_, camera_, face, pixel)};
}

Eigen::Vector2i RestViews::PixelOf(const Eigen::Vector3d& point) const {
  Eigen::Vector2d pixel;
  camera_.Project(Of(RestSide::kFront).sign.cwiseProduct(point), &pixel);
  return {Nearest(pixel.x()), Nearest(pixel.y())};
}

Eigen::Vector3d RestViews::PointAt(int x, int y) const {
  const Eigen::Vector2d metres = camera_.Unproject(Eigen::Vector2d(x, y));
  return {metres.x(), -metres.y(), 0};
}

}  // namespace bodyloom
