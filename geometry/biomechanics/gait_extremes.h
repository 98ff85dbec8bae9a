// SPDX-License-Identifier: Apache-2.0
/// Signals over time for the analysis of gait (geometry/biomechanics/gait.h): stretches without gaps, slopes, extremes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

namespace bodyloom {

/// Stretches [begin, end) of known frames, at least a second long, without a step of more than 2.5 median ones.
std::vector<std::pair<size_t, size_t>> KnownStretches(const std::vector<double>& times, const std::vector<bool>& known);

/// Slope of the line fitted to the points within 0.5 s of each time; zero where there is one point alone.
std::vector<Eigen::Vector2d> LocalSlopes(const std::vector<double>& times, const std::vector<Eigen::Vector2d>& points);

/// A maximum of a signal.
struct Extreme {
  size_t index = 0;    ///< of the highest sample
  double seconds = 0;  ///< vertex of the parabola through it and its neighbours
};

/// Maxima of the signal averaged over 0.1 s, before and after which it falls by `swing` and more.
std::vector<Extreme> Maxima(const std::vector<double>& times, const std::vector<double>& values, double swing);

}  // namespace bodyloom
