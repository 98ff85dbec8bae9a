// SPDX-License-Identifier: Apache-2.0
#include "render/view/floor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "geometry/base/check.h"
#include "render/image/image.h"
#include "render/image/image_mat.h"
#include "render/raster/visibility_buffer.h"
#include "render/view/drawing_units.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Two axes in the floor: `right` is perpendicular to the viewing direction.
void FloorAxes(const Floor& floor, Vector3d* right, Vector3d* ahead) {
  Vector3d across = Vector3d::UnitX() - Vector3d::UnitX().dot(floor.up) * floor.up;
  if (across.norm() < 1e-3) across = Vector3d::UnitY() - Vector3d::UnitY().dot(floor.up) * floor.up;
  *right = across.normalized();
  *ahead = right->cross(floor.up).normalized();
}

}  // namespace

Floor RaisedFloor(const Floor& floor, double height) {
  return {floor.point + height * floor.up.normalized(), floor.up};
}

std::optional<Floor> FloorUnder(const std::vector<MatrixX3d>& joints, const Vector3d& up_in) {
  const Vector3d up = up_in.normalized();
  double lowest = std::numeric_limits<double>::infinity();
  for (const MatrixX3d& frame : joints) {
    if (frame.rows() > 0) lowest = std::min(lowest, (frame * up).minCoeff());
  }
  if (!std::isfinite(lowest)) return std::nullopt;
  return Floor{(lowest - 0.04) * up, up};
}

std::optional<Floor> FloorOfWorld(const Track& track) {
  if (!track.world) return std::nullopt;
  const WorldSource source = track.world->source;
  if (source == WorldSource::kLevelCamera || source == WorldSource::kVertical) return std::nullopt;
  const Vector3d up = track.world->up_in_camera();
  return Floor{-track.world->camera_height_m() * up, up};
}

void DrawFloorGrid(const Floor& floor_in, const Vector3d& centre, const FloorGridStyle& style, const Camera& camera,
                   Image* image) {
  BODYLOOM_CHECK(style.spacing_m > 0 && style.radius_m > 0, "floor grid: spacing ", style.spacing_m, " m, radius ",
                 style.radius_m, " m");
  const Floor floor{floor_in.point, floor_in.up.normalized()};
  Vector3d right, ahead;
  FloorAxes(floor, &right, &ahead);
  const Vector2d middle(right.dot(centre - floor.point), ahead.dot(centre - floor.point));
  constexpr int kPiecesPerCell = 4;
  cv::Mat mask(image->height, image->width, CV_8UC1, cv::Scalar(0));

  const auto to_pixel = [&](const Vector2d& at, cv::Point* pixel) {
    Vector2d p;
    const Vector3d X = floor.point + at.x() * right + at.y() * ahead;
    if (camera.model == CameraModel::kPinhole && X.z() < 0.1) return false;
    if (!camera.Project(X, &p) || !IsDrawable(p)) return false;
    *pixel = FixedPoint(p);
    return true;
  };
  const int reach = static_cast<int>(std::ceil(style.radius_m / style.spacing_m));
  const double piece = style.spacing_m / kPiecesPerCell;
  const int thickness = std::max(1, static_cast<int>(std::lround(image->height / 700.0)));
  for (int axis = 0; axis < 2; ++axis) {
    const auto first_line = static_cast<int>(std::lround(middle[axis] / style.spacing_m)) - reach;
    const auto first_piece = static_cast<int>(std::lround(middle[1 - axis] / style.spacing_m)) - reach;
    for (int line = first_line; line <= first_line + 2 * reach; ++line) {
      for (int k = first_piece * kPiecesPerCell; k < (first_piece + 2 * reach) * kPiecesPerCell; ++k) {
        Vector2d a, b;
        a[axis] = b[axis] = line * style.spacing_m;
        a[1 - axis] = k * piece;
        b[1 - axis] = (k + 1) * piece;
        const double distance = (0.5 * (a + b) - middle).norm() / style.radius_m;
        if (distance >= 1) continue;
        cv::Point p, q;
        if (!to_pixel(a, &p) || !to_pixel(b, &q)) continue;
        const double fade = 1 - distance * distance;
        cv::line(mask, p, q, 255 * fade * fade, thickness, cv::LINE_AA, kDrawingShift);
      }
    }
  }
  for (int y = 0; y < image->height; ++y) {
    for (int x = 0; x < image->width; ++x) {
      const uint8_t m = mask.at<uint8_t>(y, x);
      if (m == 0) continue;
      const double a = style.alpha * m / 255;
      uint8_t* p = image->pixel(x, y);
      p[0] = NearestByte(p[0] * (1 - a) + style.colour.blue * a);
      p[1] = NearestByte(p[1] * (1 - a) + style.colour.green * a);
      p[2] = NearestByte(p[2] * (1 - a) + style.colour.red * a);
    }
  }
}

void DrawShadow(const MatrixX3d& vertices, const MatrixX3i& faces, const Floor& floor_in, const Camera& camera,
                double strength, Image* image, const Vector2d& slant) {
  const Floor floor{floor_in.point, floor_in.up.normalized()};
  Vector3d right, ahead;
  FloorAxes(floor, &right, &ahead);
  const Vector3d fall = (-floor.up + slant.x() * right + slant.y() * ahead).normalized();
  MatrixX3d flat(vertices.rows(), 3);
  double height = 0;
  for (int v = 0; v < vertices.rows(); ++v) {
    const Vector3d x = vertices.row(v).transpose();
    const double above = floor.up.dot(x - floor.point);
    height = std::max(height, above);
    flat.row(v) = (x + above / -floor.up.dot(fall) * fall).transpose();
  }
  // Half the resolution suffices for a shadow blurred by a few centimetres.
  constexpr double kScale = 0.5;
  VisibilityBuffer buffer;
  const Camera coarse = ScaledCamera(camera, kScale);
  buffer.Render(flat, faces, coarse, {.cull_back_faces = false});
  if (buffer.box().empty()) return;
  Vector2d a, b;
  const Vector3d middle = flat.colwise().mean().transpose();
  if (!coarse.Project(middle, &a) || !coarse.Project(middle + 0.03 * right, &b)) return;
  const double blur = std::clamp((b - a).norm(), 0.7, 40.0);
  const PixelBox box =
      buffer.box().GrownBy(static_cast<int>(3 * blur) + 2).ClippedTo({0, 0, coarse.width, coarse.height});
  cv::Mat mask(box.height(), box.width(), CV_32FC1);
  for (int y = 0; y < box.height(); ++y) {
    for (int x = 0; x < box.width(); ++x) {
      mask.at<float>(y, x) = buffer.FaceAt(box.x_begin + x, box.y_begin + y) >= 0 ? 1.0f : 0.0f;
    }
  }
  cv::GaussianBlur(mask, mask, {0, 0}, blur, blur, cv::BORDER_REPLICATE);
  cv::resize(mask, mask, {}, 1 / kScale, 1 / kScale, cv::INTER_LINEAR);
  const int x_0 = static_cast<int>(box.x_begin / kScale), y_0 = static_cast<int>(box.y_begin / kScale);
  for (int y = 0; y < std::min(mask.rows, image->height - y_0); ++y) {
    for (int x = 0; x < std::min(mask.cols, image->width - x_0); ++x) {
      const double keep = 1 - strength * mask.at<float>(y, x);
      uint8_t* p = image->pixel(x_0 + x, y_0 + y);
      for (int c = 0; c < 3; ++c) p[c] = NearestByte(p[c] * keep);
    }
  }
}

namespace {

/// Orders world frames by certainty: by source, then by the spread of the vertical. Larger is more certain.
std::pair<int, double> SurenessOf(const WorldFrame& world) {
  const double sigma = world.vertical_sigma_deg;
  return {static_cast<int>(world.source), std::isfinite(sigma) ? -sigma : -180};
}

}  // namespace

WorldFrame WorldUnderJoints(const Eigen::Vector3d& up_in_camera, const std::vector<MatrixX3d>& joints) {
  const std::optional<Floor> floor = FloorUnder(joints, up_in_camera);
  WorldFrame world = WorldOverGround(up_in_camera, floor ? -floor->point.dot(floor->up) : 0);
  world.source = WorldSource::kVertical;
  return world;
}

WorldFrame AssumedWorld(const std::vector<MatrixX3d>& joints) {
  WorldFrame world = WorldUnderJoints(-Eigen::Vector3d::UnitY(), joints);
  world.source = WorldSource::kLevelCamera;
  return world;
}

WorldFrame WorldOfTracks(const std::vector<const Track*>& tracks, const std::vector<MatrixX3d>& joints) {
  const WorldFrame* best = nullptr;
  for (const Track* track : tracks) {
    if (!track->world || track->world->source == WorldSource::kLevelCamera) continue;
    if (best == nullptr || SurenessOf(*track->world) > SurenessOf(*best)) best = &*track->world;
  }
  return best != nullptr ? *best : AssumedWorld(joints);
}

}  // namespace bodyloom
