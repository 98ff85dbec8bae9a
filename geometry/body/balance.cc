// SPDX-License-Identifier: Apache-2.0
#include "geometry/body/balance.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/body/centre_of_mass.h"

namespace bodyloom {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kHalfWindowS = 0.15, kFurthestNeighbourS = 0.25, kSlowMps2 = 1.5, kHullMarginM = 0.04,
                 kOutsideM = 0.05;

/// Above 0 where the path from a over b to c turns left.
double TurnAt(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d ab = b - a, bc = c - b;
  return ab.x() * bc.y() - ab.y() * bc.x();
}

/// Frames [first, last] around i without a gap, at most half a window away, and its neighbours.
std::pair<size_t, size_t> WindowAround(const std::vector<SupportedFrame>& frames, size_t i) {
  size_t first = i, last = i;
  const auto belongs = [&](size_t other, bool is_neighbour) {
    const double apart = std::abs(frames[other].seconds - frames[i].seconds) - 1e-9;  // rounding of timestamps
    return apart <= (is_neighbour ? kFurthestNeighbourS : kHalfWindowS);
  };
  while (first > 0 && frames[first].continues && belongs(first - 1, first == i)) --first;
  while (last + 1 < frames.size() && frames[last + 1].continues && belongs(last + 1, last == i)) ++last;
  return {first, last};
}

/// True if the window reaches to both sides, and neither the clip's ends nor a gap cut it short: a frame follows it on
/// each side, or it is as long as it may be.
bool IsWhole(const std::vector<SupportedFrame>& frames, size_t i, const std::pair<size_t, size_t>& window) {
  const auto [first, last] = window;
  const double rounding = 1e-9;
  const bool from =
      frames[i].seconds - frames[first].seconds >= kHalfWindowS - rounding || (first > 0 && frames[first].continues);
  const bool to = frames[last].seconds - frames[i].seconds >= kHalfWindowS - rounding ||
                  (last + 1 < frames.size() && frames[last + 1].continues);
  return first < i && i < last && from && to;
}

struct Motion2 {
  Vector3d place, acceleration;
};

Motion2 FitParabola(const std::vector<SupportedFrame>& frames, size_t i, const std::pair<size_t, size_t>& window) {
  const auto [first, last] = window;
  const auto n = static_cast<Eigen::Index>(last - first + 1);
  Eigen::MatrixX3d powers(n, 3), places(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    const SupportedFrame& frame = frames[first + static_cast<size_t>(k)];
    const double t = frame.seconds - frames[i].seconds;
    powers.row(k) << 1, t, t * t;
    places.row(k) = frame.centre_of_mass.transpose();
  }
  const Eigen::Matrix3d parabola = powers.colPivHouseholderQr().solve(places);
  return {parabola.row(0).transpose(), 2 * parabola.row(2).transpose()};
}

}  // namespace

std::vector<Vector2d> ConvexHull(std::vector<Vector2d> points) {
  const auto before = [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  // Andrew's chains: the lower one from left to right, then the upper one back.
  std::vector<Vector2d> hull;
  const auto extend = [&](const Vector2d& point, size_t base) {
    while (hull.size() >= base + 2 && TurnAt(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
    hull.push_back(point);
  };
  for (const Vector2d& point : points) extend(point, 0);
  const size_t lower = hull.size() - 1;
  for (size_t k = points.size() - 1; k-- > 0;) extend(points[k], lower);
  hull.pop_back();
  return hull;
}

double DistanceOutside(const std::vector<Vector2d>& hull, const Vector2d& point) {
  BODYLOOM_CHECK(!hull.empty(), "distance outside a hull: it has no point, expected at least one");
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = hull.size() > 2;
  for (size_t k = 0; k < hull.size(); ++k) {
    const Vector2d& next = hull[(k + 1) % hull.size()];
    const Vector2d edge = next - hull[k], from = point - hull[k];
    inside = inside && TurnAt(hull[k], next, point) >= 0;
    const double length2 = edge.squaredNorm();
    const double at = length2 > 0 ? std::clamp(from.dot(edge) / length2, 0.0, 1.0) : 0;
    nearest = std::min(nearest, (from - at * edge).norm());
  }
  return inside ? 0 : nearest;
}

Balance MeasureBalance(const std::vector<SupportedFrame>& frames) {
  std::vector<double> distances;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].contacts.empty()) continue;
    const auto window = WindowAround(frames, i);
    if (!IsWhole(frames, i, window)) continue;
    const Motion2 motion = FitParabola(frames, i, window);
    if (!(motion.acceleration.norm() < kSlowMps2)) continue;
    const Vector2d point = ZeroMomentPoint(motion.place, motion.acceleration);
    distances.push_back(std::max(0.0, DistanceOutside(ConvexHull(frames[i].contacts), point) - kHullMarginM));
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (distances.empty()) return {0, kNone, kNone};
  const auto outside = std::count_if(distances.begin(), distances.end(), [](double d) { return d > kOutsideM; });
  return {static_cast<int>(distances.size()), static_cast<double>(outside) / static_cast<double>(distances.size()),
          Percentile(distances, 95)};
}

}  // namespace bodyloom
