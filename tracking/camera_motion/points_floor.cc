// SPDX-License-Identifier: Apache-2.0
#include "tracking/camera_motion/points_floor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "tracking/problem/robust.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kFloorSamples = 300, kMinOnFloor = 20, kFloorRefinements = 15;
constexpr double kTolerance = 0.02, kMaxTurnOfUp = 20 * kDegree, kMaxBelow = 1.0 / 3;
constexpr double kMadToSigma = 1.4826, kFloorKernel = 3;
constexpr double kCorrelated = 4;  ///< of neighbouring points' errors: as many points count as one
constexpr double kMinUpSigmaRad = 0.3 * kDegree, kMaxUpSigmaRad = 3 * kDegree;

double Off(const PointsFloor& floor, const Vector3d& point) { return floor.HeightOf(point) / point.norm(); }

/// Score of the header; 0 with too many points below.
double Score(const PointsFloor& floor, const std::vector<Vector3d>& points) {
  double score = 0;
  int on = 0, below = 0;
  for (const Vector3d& point : points) {
    const double share = Off(floor, point) / kTolerance;
    if (std::abs(share) < 1) score += 1 - share * share, ++on;
    below += share < -2 ? 1 : 0;
  }
  return below > kMaxBelow * on ? 0 : score;
}

/// Least squares of Off() about the floor, reweighted; sets what the floor holds but `found` and `why`.
void Refine(const std::vector<Vector3d>& points, PointsFloor* floor) {
  double sigma = kTolerance / 2;
  for (int pass = 0; pass < kFloorRefinements; ++pass) {
    floor->a = floor->up.unitOrthogonal();
    floor->b = floor->up.cross(floor->a);
    Matrix3d H = Matrix3d::Identity() * 1e-12;
    Vector3d g = Vector3d::Zero();
    std::vector<double> offs;
    double squares = 0, weights = 0;
    for (const Vector3d& point : points) {
      const double off = Off(*floor, point);
      if (std::abs(off) > kTolerance) continue;
      const Vector3d j = Vector3d(floor->a.dot(point), floor->b.dot(point), 1) / point.norm();
      const double weight = GemanMcClure(off * off / (sigma * sigma), kFloorKernel).weight;
      H += weight * j * j.transpose();
      g += weight * off * j;
      squares += weight * off * off;
      weights += weight;
      offs.push_back(std::abs(off));
    }
    if (offs.size() < 4) return;
    floor->points = static_cast<int>(offs.size());
    floor->covariance = kCorrelated * squares / std::max(1.0, weights - 3) * H.inverse();
    floor->covariance.topLeftCorner<2, 2>().diagonal().array() += kMinUpSigmaRad * kMinUpSigmaRad;
    const Vector3d step = H.ldlt().solve(-g);
    floor->up = (floor->up + step[0] * floor->a + step[1] * floor->b).normalized();
    floor->height += step[2];
    sigma = std::clamp(kMadToSigma * Percentile(offs, 50), 1e-6, kTolerance / 2);
  }
}

}  // namespace

double PointsFloor::SigmaAt(const Vector3d& place) const {
  const Vector3d j(a.dot(place), b.dot(place), 1);
  return std::sqrt(j.dot(covariance * j));
}

double PointsFloor::UpSigma() const { return std::sqrt(covariance.topLeftCorner<2, 2>().trace() / 2); }

PointsFloor FindPointsFloor(std::span<const Vector3d> points, const Vector3d& expected_up) {
  BODYLOOM_CHECK(std::abs(expected_up.norm() - 1) < 1e-6, "floor: an up of length ", expected_up.norm(),
                 ", expected 1");
  std::vector<Vector3d> lower;  // than the camera
  for (const Vector3d& point : points) {
    if (point.allFinite() && point.norm() > 0 && expected_up.dot(point) < 0) lower.push_back(point);
  }
  PointsFloor best;
  best.up = expected_up;
  best.why = "few points lie below the camera";
  if (lower.size() < size_t(kMinOnFloor)) return best;
  HashRandom random(lower.size(), {17});
  double best_score = 0;
  for (int n = 0; n < kFloorSamples; ++n) {
    const Vector3d &p = lower[random.Below(lower.size())], &q = lower[random.Below(lower.size())],
                   &r = lower[random.Below(lower.size())];
    Vector3d normal = (q - p).cross(r - p);
    if (!(normal.norm() > 0)) continue;
    normal.normalize();
    if (normal.dot(expected_up) < 0) normal = -normal;
    if (normal.dot(expected_up) < std::cos(kMaxTurnOfUp)) continue;
    PointsFloor tried;
    tried.up = normal;
    tried.height = -normal.dot(p);
    if (!(tried.height > 0)) continue;
    if (const double score = Score(tried, lower); score > best_score) best_score = score, best = tried;
  }
  best.why = "no level plane is among the points below the camera";
  if (!(best_score > 0)) return best;
  Refine(lower, &best);
  if (best.points < kMinOnFloor || !(best.height > 0) || !(best.UpSigma() <= kMaxUpSigmaRad)) return best;
  best.found = true;
  best.why = std::to_string(best.points) + " points on the floor";
  return best;
}

}  // namespace bodyloom
