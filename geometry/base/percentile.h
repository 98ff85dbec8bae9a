// SPDX-License-Identifier: Apache-2.0
/// Order statistics of a set of numbers.
#pragma once

#include <span>
#include <vector>

namespace bodyloom {

/// Returns the finite values in ascending order.
std::vector<double> SortedFinite(std::span<const double> values);

/// The value below which `percent` of the numbers lie: linear interpolation between the order statistics at
/// (n − 1)·percent/100 (numpy's default). `sorted` is finite and ascending. NaN when it is empty.
/// Throws std::invalid_argument unless percent is in [0, 100].
double SortedPercentile(std::span<const double> sorted, double percent);

/// The same for the finite ones among `values`, which may be in any order.
double Percentile(std::span<const double> values, double percent);

}  // namespace bodyloom
