// SPDX-License-Identifier: Apache-2.0
/// Order statistics of a set of numbers.
#pragma once

#include <span>
#include <vector>

namespace bodyloom {

/// The finite ones of `values`, smallest first.
std::vector<double> SortedFinite(std::span<const double> values);

/// The value below which `percent` of the numbers lie: linear interpolation between the order statistics at
/// (n − 1)·percent/100 (numpy's default). `sorted` are finite, smallest first. NaN without a value.
/// Throws std::invalid_argument unless percent is in [0, 100].
double SortedPercentile(std::span<const double> sorted, double percent);

/// The same of the finite ones among `values`, in any order.
double Percentile(std::span<const double> values, double percent);

}  // namespace bodyloom
