// SPDX-License-Identifier: Apache-2.0
#include "render/view/ground_marks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"
#include "render/image/palette.h"
#include "render/view/caption.h"
#include "render/view/drawing_units.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kApartM = 0.12, kDiscRadiusM = 0.04;
constexpr size_t kMostDiscs = 12;
constexpr Colour kBelowFloorColour{214, 40, 40};

/// False where the camera does not see the point.
bool MarkPixel(const Vector3d& point, const Camera& camera, cv::Point* pixel) {
  Vector2d p;
  if (camera.model == CameraModel::kPinhole && point.z() < Camera::kMinDepth) return false;
  if (!camera.Project(point, &p) || !IsDrawable(p)) return false;
  *pixel = FixedPoint(p);
  return true;
}

void DrawDisc(const Vector3d& centre, const Vector3d& up, const Camera& camera, Image* image) {
  constexpr int kCorners = 20;
  const Vector3d across = up.unitOrthogonal();
  std::vector<cv::Point> rim(kCorners);
  for (int k = 0; k < kCorners; ++k) {
    const Vector3d spoke = Eigen::AngleAxisd(2 * M_PI * k / kCorners, up) * across;
    if (!MarkPixel(centre + kDiscRadiusM * spoke, camera, &rim[static_cast<size_t>(k)])) return;
  }
  cv::Mat target = MatOf(image);
  cv::polylines(target, rim, true, ScalarOf(kInkColour), 2, cv::LINE_AA, kDrawingShift);
  cv::fillConvexPoly(target, rim, ScalarOf(kDetectedColour), cv::LINE_AA, kDrawingShift);
}

}  // namespace

FloorContact ContactWithFloor(const MatrixX3d& vertices, const Floor& floor) {
  BODYLOOM_CHECK(vertices.rows() > 0, "floor contact: the body has no vertex");
  const Vector3d up = floor.up.normalized();
  const Eigen::VectorXd heights = (vertices.rowwise() - floor.point.transpose()) * up;
  std::vector<std::pair<double, Eigen::Index>> low;
  for (Eigen::Index v = 0; v < heights.size(); ++v) {
    if (heights[v] <= kTouchesFloorM) low.emplace_back(heights[v], v);
  }
  std::sort(low.begin(), low.end());
  FloorContact contact;
  Eigen::Index lowest = 0;
  contact.lowest_m = heights.minCoeff(&lowest);
  contact.lowest = vertices.row(lowest).transpose();
  std::vector<Vector3d> feet;  // on the floor, of the lowest vertex of each part
  for (const auto& [height, v] : low) {
    const Vector3d foot = vertices.row(v).transpose() - height * up;
    const bool apart =
        std::all_of(feet.begin(), feet.end(), [&](const Vector3d& other) { return (foot - other).norm() > kApartM; });
    if (!apart) continue;
    feet.push_back(foot);
    if (height >= -kTouchesFloorM && contact.touching.size() < kMostDiscs) contact.touching.push_back(foot);
  }
  return contact;
}

void DrawFloorContact(const FloorContact& contact, const Floor& floor, const Camera& camera, double cap_px,
                      Image* image) {
  const Vector3d up = floor.up.normalized();
  for (const Vector3d& point : contact.touching) DrawDisc(point, up, camera, image);
  if (std::abs(contact.lowest_m) <= kTouchesFloorM) return;
  cv::Point from, to;
  if (!MarkPixel(contact.lowest, camera, &from) || !MarkPixel(contact.lowest - contact.lowest_m * up, camera, &to)) {
    return;
  }
  const Colour colour = contact.lowest_m > 0 ? kInkColour : kBelowFloorColour;
  const int thickness = std::max(1, static_cast<int>(std::lround(cap_px / 8)));
  cv::Mat target = MatOf(image);
  cv::line(target, from, to, ScalarOf(colour), thickness, cv::LINE_AA, kDrawingShift);
  const std::string height = std::to_string(std::lround(100 * contact.lowest_m)) + " cm";
  const int middle = (from.y + to.y) / (2 << kDrawingShift), cap = static_cast<int>(std::ceil(cap_px));
  const int width = static_cast<int>(std::ceil(WidthOfWords(height, cap_px)));
  const int x = std::clamp((to.x >> kDrawingShift) + cap / 2, 0, std::max(0, image->width - width - cap));
  const int baseline = std::clamp(middle + cap / 2, 2 * cap, std::max(2 * cap, image->height - cap));
  DrawWords(height, x, baseline, cap_px, colour, image);
}

}  // namespace bodyloom
