// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/texel_counterparts.h"

#include <algorithm>
#include <cmath>

#include "geometry/body/skinning.h"
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

MatrixX3d TexelPoints(const MatrixX3d& rest_vertices, const MatrixX3i& faces, const UvTexelTable& table) {
  MatrixX3d points(static_cast<Eigen::Index>(table.size()), 3);
  for (size_t i = 0; i < table.size(); ++i) {
    const Eigen::RowVector3d weights = table.barycentric[i].cast<double>().transpose();
    points.row(static_cast<Eigen::Index>(i)).setZero();
    for (int k = 0; k < 3; ++k) {
      points.row(static_cast<Eigen::Index>(i)) += weights[k] * rest_vertices.row(faces(table.face[i], k));
    }
  }
  return points;
}

TexelCounterparts FindTexelCounterparts(const RestViews& views, const MatrixX3d& points) {
  TexelCounterparts counterparts;
  for (auto& of_kind : counterparts) of_kind.resize(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector3d point = points.row(i).transpose(), mirrored(-point.x(), point.y(), point.z());
    const std::optional<RestSide> side = views.SideOf(point);
    if (!side) continue;
    const RestSide other = *side == RestSide::kFront ? RestSide::kBack : RestSide::kFront;
    counterparts[kMirror][i] = views.At(*side, mirrored);
    counterparts[kBehind][i] = views.At(other, point);
    counterparts[kMirroredBack][i] = views.At(other, mirrored);
  }
  return counterparts;
}

namespace {

constexpr int kEdge = 4;  ///< pixels
constexpr int kSide = RestViews::kPixels;

}  // namespace

NearestAroundLimb::NearestAroundLimb(const BodyModel& body, const RestViews& views,
                                     const std::function<bool(const SurfacePoint&)>& is_known)
    : views_(views), found_(static_cast<size_t>(kSide) * kSide) {
  const std::vector<double> of_arms = WeightsBelow(body, {"l_shoulder", "r_shoulder"});
  enum : uint8_t { kNothing, kInFront, kBehind };
  std::vector<uint8_t> known(found_.size(), kNothing), is_arm(found_.size(), 0), covered(found_.size(), 0);
  const auto at = [](int x, int y) { return static_cast<size_t>(y) * kSide + x; };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector3d place = views.PointAt(x, y);
      const SurfacePoint front = views.At(RestSide::kFront, place), back = views.At(RestSide::kBack, place);
      if (front.face < 0 && back.face < 0) continue;
      covered[at(x, y)] = 1;
      const int face = front.face >= 0 ? front.face : back.face;
      is_arm[at(x, y)] = of_arms[body.data().faces(face, 0)] > 0.5 ? 1 : 0;
      if (front.face >= 0 && is_known(front)) {
        known[at(x, y)] = kInFront;
      } else if (back.face >= 0 && is_known(back)) {
        known[at(x, y)] = kBehind;
      }
    }
  }
  // Known pixels near the boundary mix with their neighbours: interior pixels are preferred.
  std::vector<uint8_t> inside(known.size(), 0);
  for (int y = kEdge; y + kEdge < kSide; ++y) {
    for (int x = kEdge; x + kEdge < kSide; ++x) {
      bool all = true;
      for (int d = -kEdge; d <= kEdge && all; ++d) {
        all = known[is_arm[at(x, y)] != 0 ? at(x, y + d) : at(x + d, y)] != kNothing;
      }
      inside[at(x, y)] = all ? 1 : 0;
    }
  }
  // Along a line, the last known pixel of the same kind (arm or not) from either end.
  const auto sweep = [&](bool arms, bool whole, const std::function<size_t(int, int)>& place) {
    const auto counts = [&](size_t p) {
      return (whole ? inside[p] != 0 : known[p] != kNothing) && is_arm[p] == (arms ? 1 : 0);
    };
    for (int line = 0; line < kSide; ++line) {
      std::array<int, kSide> before{};
      int last = -1;
      for (int i = 0; i < kSide; ++i) {
        if (counts(place(line, i))) last = i;
        before[i] = last;
      }
      last = -1;
      for (int i = kSide - 1; i >= 0; --i) {
        const size_t p = place(line, i);
        if (counts(p)) last = i;
        if (covered[p] == 0 || is_arm[p] != (arms ? 1 : 0) || found_[p].x >= 0) continue;
        int best = before[i];
        if (last >= 0 && (best < 0 || last - i < i - best)) best = last;
        if (best < 0) continue;
        const size_t q = place(line, best);
        found_[p] = {static_cast<int16_t>(q % kSide), static_cast<int16_t>(q / kSide), known[q] == kBehind};
      }
    }
  };
  for (const bool whole : {true, false}) {
    sweep(false, whole, [&](int row, int i) { return at(i, row); });
    sweep(true, whole, [&](int column, int i) { return at(column, i); });
  }
}

SurfacePoint NearestAroundLimb::At(const Eigen::Vector3d& point) const {
  const Eigen::Vector2i pixel = views_.PixelOf(point);
  // A point of the contour may lie beside the last pixel that shows the body.
  constexpr std::array<std::array<int, 2>, 5> kNear = {{{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (const auto& [dx, dy] : kNear) {
    const int x = pixel.x() + dx, y = pixel.y() + dy;
    if (x < 0 || y < 0 || x >= kSide || y >= kSide) continue;
    const Found& found = found_[static_cast<size_t>(y) * kSide + x];
    if (found.x < 0) continue;
    return views_.At(found.behind ? RestSide::kBack : RestSide::kFront, views_.PointAt(found.x, found.y));
  }
  return {};
}

}  // namespace bodyloom
