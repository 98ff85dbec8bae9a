// SPDX-License-Identifier: Apache-2.0
#include "tracking/rig/align_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/time_bracket.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kRate = 15;        // moments a second of the grid
constexpr int kMaxMoments = 3000;   // of the longer clip; a longer one has a coarser grid
constexpr double kFineRate = 240;   // offsets a second of the refinement
constexpr double kMaxStep_s = 0.3;  // that is interpolated
constexpr double kMinOther_m = 0.15, kMinDistance_m = 0.03;
constexpr double kMinRepeat_s = 0.5, kRepeatRatio = 1.1;
/// Overlap of full evidence: this time, or this share of the shorter clip if that is less.
constexpr double kTogether_s = 3, kTogetherShare = 0.8;
/// Errors of a monocular track last for a third of a second, and its points move together as six limbs do.
constexpr double kIndependent_s = 1.0 / 3, kIndependentPoints = 6;

/// A motion at the moments begin + i step of its clock; zeros where it is not known.
struct Sampled {
  double begin = 0, step = 0;
  int count = 0, num_points = 0;
  Eigen::MatrixX3d points;  ///< (count K)×3 about the centre; by columns, for their products
  MatrixX3d centres;        ///< count×3
  VectorXd known, squares;  ///< count: 1 or 0; sum over the points of their squares
};

Sampled Sample(const ViewMotion& motion, double begin, double step, int count) {
  Sampled result;
  const auto K = motion.points[0].rows();
  result.begin = begin;
  result.step = step;
  result.count = count;
  result.num_points = static_cast<int>(K);
  result.points.setZero(count * K, 3);
  result.centres.setZero(count, 3);
  result.known.setZero(count);
  result.squares.setZero(count);
  MatrixX3d points;
  for (int i = 0; i < count; ++i) {
    if (!PointsAt(motion, begin + i * step, &points)) continue;
    result.centres.row(i) = points.colwise().mean();
    result.points.middleRows(i * K, K) = points.rowwise() - result.centres.row(i);
    result.squares[i] = result.points.middleRows(i * K, K).squaredNorm();
    result.known[i] = 1;
  }
  return result;
}

/// The best rotation of a's moments onto b's, b's being `lag` moments later in its own grid.
struct LagFit {
  int moments = 0;
  double squared = 0;  ///< d
  Matrix3d rotation = Matrix3d::Identity();
};

/// Adds Σ y xᵀ over the points x of a's moments from `begin` to `end` and those y of b, `lag` later. Unknown ones are
/// zero and add nothing.
void AddProducts(const Sampled& a, const Sampled& b, int lag, int begin, int end, Matrix3d* sum) {
  const int K = a.num_points, from = std::max(begin, -lag), rows = (std::min(end, b.count - lag) - from) * K;
  if (rows <= 0) return;
  for (int r = 0; r < 3; ++r) {
    const auto y = b.points.col(r).segment((from + lag) * K, rows);
    for (int c = 0; c < 3; ++c) (*sum)(r, c) += y.dot(a.points.col(c).segment(from * K, rows));
  }
}

/// The same over all moments, for every lag from 1 − a.count to b.count − 1: by runs of a's moments, which stay in the
/// cache while b's pass by.
std::vector<Matrix3d> ProductsOfLags(const Sampled& a, const Sampled& b) {
  constexpr int kRun = 32;
  std::vector<Matrix3d> sums(a.count + b.count - 1, Matrix3d::Zero());
  for (int begin = 0; begin < a.count; begin += kRun) {
    const int end = std::min(begin + kRun, a.count);
    for (int lag = 1 - end; lag < b.count - begin; ++lag) {
      AddProducts(a, b, lag, begin, end, &sums[lag + a.count - 1]);
    }
  }
  return sums;
}

/// `products`: those of the lag.
LagFit FitRotation(const Sampled& a, const Sampled& b, int lag, const Matrix3d& products) {
  const int first = std::max(0, -lag), count = std::min(a.count, b.count - lag) - first;
  LagFit fit;
  const auto known_a = a.known.segment(first, count), known_b = b.known.segment(first + lag, count);
  fit.moments = static_cast<int>(known_a.dot(known_b));
  if (fit.moments == 0) return fit;
  const double sum = a.squares.segment(first, count).dot(known_b) + b.squares.segment(first + lag, count).dot(known_a);
  fit.rotation = NearestRotation(products);
  fit.squared = std::max(0.0, sum - 2 * fit.rotation.cwiseProduct(products).sum()) /
                (static_cast<double>(fit.moments) * a.num_points);
  return fit;
}

/// Of a and b at the same moments.
LagFit FitRotation(const Sampled& a, const Sampled& b) {
  Matrix3d products = Matrix3d::Zero();
  AddProducts(a, b, 0, 0, a.count, &products);
  return FitRotation(a, b, 0, products);
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double LengthOf(const ViewMotion& motion) { return motion.timestamps.back() - motion.timestamps.front(); }

/// Median over what both know of c_b − R c_a.
Vector3d TranslationOf(const Sampled& a, const Sampled& b, const Matrix3d& rotation) {
  std::array<std::vector<double>, 3> of_axis;
  for (int i = 0; i < a.count; ++i) {
    if (a.known[i] == 0 || b.known[i] == 0) continue;
    const Vector3d move = b.centres.row(i).transpose() - rotation * a.centres.row(i).transpose();
    for (int axis = 0; axis < 3; ++axis) of_axis[axis].push_back(move[axis]);
  }
  return {MedianOf(of_axis[0]), MedianOf(of_axis[1]), MedianOf(of_axis[2])};
}

}  // namespace

bool PointsAt(const ViewMotion& motion, double time, MatrixX3d* points) {
  const std::optional<TimeBracket> at = FindTimeBracket(motion.timestamps, time);
  if (!at || at->gap_s > kMaxStep_s) return false;
  const MatrixX3d &a = motion.points[at->before], &b = motion.points[at->after];
  if (!a.allFinite() || !b.allFinite()) return false;
  *points = (1 - at->s) * a + at->s * b;
  return true;
}

MotionAlignment AlignMotions(const ViewMotion& a, const ViewMotion& b) {
  for (const ViewMotion* motion : {&a, &b}) {
    BODYLOOM_CHECK(!motion->points.empty() && motion->points.size() == motion->timestamps.size(),
                   "align motions: ", motion->points.size(), " frames of points, ", motion->timestamps.size(),
                   " timestamps");
  }
  for (const ViewMotion* motion : {&a, &b}) {
    for (size_t i = 0; i < motion->points.size(); ++i) {
      BODYLOOM_CHECK(motion->points[i].rows() == a.points[0].rows(), "align motions: ", motion->points[i].rows(),
                     " points in frame ", i, ", expected ", a.points[0].rows());
      BODYLOOM_CHECK(i == 0 || motion->timestamps[i] > motion->timestamps[i - 1], "align motions: frame ", i, " at ",
                     motion->timestamps[i], " s comes after ", motion->timestamps[i - 1], " s");
    }
  }
  MotionAlignment result;
  const double longest = std::max(LengthOf(a), LengthOf(b));
  const double step = std::max(1 / kRate, longest / kMaxMoments);
  const auto grid = [&](const ViewMotion& motion) {
    return Sample(motion, motion.timestamps.front(), step, 1 + static_cast<int>(LengthOf(motion) / step + 1e-9));
  };
  const Sampled of_a = grid(a), of_b = grid(b);
  const int shorter = std::min(of_a.count, of_b.count);
  const int needed = std::max(1, std::min(static_cast<int>(1 / step), shorter / 3));

  const std::vector<Matrix3d> products = ProductsOfLags(of_a, of_b);
  std::vector<int> lags;
  std::vector<LagFit> fits;
  std::vector<double> squared;
  for (int lag = -(of_a.count - 1); lag < of_b.count; ++lag) {
    LagFit fit = FitRotation(of_a, of_b, lag, products[lag + of_a.count - 1]);
    if (fit.moments < needed) continue;
    lags.push_back(lag);
    squared.push_back(fit.squared);
    fits.push_back(fit);
  }
  if (fits.empty()) {
    result.why = "no second of the clips in which both show the person";
    return result;
  }
  const double other = std::max(MedianOf(squared), kMinOther_m * kMinOther_m);
  const auto likelihood = [&](const LagFit& fit) {
    return fit.moments * std::log(other / std::max(fit.squared, kMinDistance_m * kMinDistance_m));
  };
  size_t best = 0;
  for (size_t i = 1; i < fits.size(); ++i) {
    if (likelihood(fits[i]) > likelihood(fits[best])) best = i;
  }
  result.other_distance_m = std::sqrt(other);
  result.distance_m = std::sqrt(fits[best].squared);
  result.score = fits[best].moments * (other - fits[best].squared) * step;
  const double together = fits[best].moments * step, enough = std::min(kTogether_s, kTogetherShare * shorter * step);
  const auto limit_of = [&](const LagFit& fit) {
    return kMaxMotionDistance_m * std::min(1.0, fit.moments * step / enough);
  };
  const double limit = limit_of(fits[best]);
  if (result.distance_m > limit) {
    result.why =
        Concatenate("the motions differ: ", std::lround(1000 * result.distance_m), " mm where they agree best, for ",
                    std::lround(10 * together) / 10.0, " s, expected at most ", std::lround(1000 * limit));
    return result;
  }

  // Around the best moment of the grid, in steps of the fine rate. Curvature: a parabola through the whole valley.
  const double coarse = of_b.begin - of_a.begin + lags[best] * step;
  const int fine = static_cast<int>(std::ceil(step * kFineRate));
  std::vector<LagFit> near;
  for (int i = -fine; i <= fine; ++i) {
    const Sampled moved = Sample(b, of_a.begin + coarse + i / kFineRate, step, of_a.count);
    near.push_back(FitRotation(of_a, moved));
  }
  int lowest = fine;
  for (int i = 0; i < static_cast<int>(near.size()); ++i) {
    if (near[i].moments >= needed && near[i].squared < near[lowest].squared) lowest = i;
  }
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < fits.size(); ++i) {
    const double beside_s = (lags[i] - lags[best]) * step, distance = std::sqrt(fits[i].squared);
    const double ratio = distance <= limit_of(fits[i]) ? kRepeatRatio : 1;
    if (std::abs(beside_s) < kMinRepeat_s || distance > ratio * result.distance_m || distance >= least) continue;
    least = distance;
    result.repeat_s = beside_s;
  }
  result.found = true;
  result.offset_s = coarse + (lowest - fine) / kFineRate;
  const Sampled there = Sample(b, of_a.begin + result.offset_s, step, of_a.count);
  const LagFit fit = FitRotation(of_a, there);
  result.distance_m = std::sqrt(fit.squared);
  result.overlap_s = fit.moments * step;
  result.b_from_a.camera_from_world_rotation = fit.rotation;
  result.b_from_a.camera_from_world_translation = TranslationOf(of_a, there, fit.rotation);
  // d(τ) = d + c (τ − τ̂)²: with n independent measurements of variance d the offset has the variance d / (n c). By
  // the errors of both, d(τ) itself varies by d / √n: d rises beside the offset of a person who stands still, too.
  const double side = 0.2;
  const double measurements = std::max(1.0, result.overlap_s / kIndependent_s) * kIndependentPoints;
  double rise = -fit.squared / std::sqrt(measurements);
  for (const double sign : {-1.0, 1.0}) {
    const LagFit beside = FitRotation(of_a, Sample(b, of_a.begin + result.offset_s + sign * side, step, of_a.count));
    rise += 0.5 * std::max(0.0, beside.squared - fit.squared);
  }
  result.offset_sigma_s = longest;
  if (rise > 0) result.offset_sigma_s = std::min(longest, side * std::sqrt(fit.squared / (measurements * rise)));
  return result;
}

}  // namespace bodyloom
