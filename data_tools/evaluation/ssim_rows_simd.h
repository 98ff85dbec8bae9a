// SPDX-License-Identifier: Apache-2.0
/// The two inner loops of Gaussian SSIM, compiled for several instruction sets and chosen at run time. Internal to
/// data_tools/evaluation/ssim.cc. The sets differ by rounding alone (fused multiply-adds).
#pragma once

#include <cstdint>
#include <vector>

namespace bodyloom::ssim_internal {

constexpr int kRadius = 5;
constexpr int kTaps = 2 * kRadius + 1;
/// Moments filtered in a window: a, b, a² + b², ab. SSIM depends on the variances only through their sum.
constexpr int kMoments = 4;
constexpr int kStrip = 256;  ///< columns worked on at once, so that their rows stay in the cache
/// Stride between the moments of a row; not a power of two, whose multiples would map to few cache sets.
constexpr int kPitch = kStrip + 24;
constexpr int kWide = kStrip + 2 * kRadius + 8;  ///< pixels of a row that are read: whole vectors of up to 8

struct Constants {
  double c1 = 0, c2 = 0;
  double covariance_norm = 1;
};

/// The moments of one row, filtered along it: out[m kPitch + x] = Σ_t w_t moment_m(x + t) for x < n ≤ kStrip, t <
/// kTaps. a, b: kWide values, those from n + 2 kRadius on are ignored. half: w_0 .. w_kRadius, the others mirror them.
void FilterAlong(const double* a, const double* b, const double* half, int n, double* out);

/// Filters kTaps such rows across, lines[0] the uppermost, and puts SSIM at x < n into ssim (kStrip values).
void SsimAcross(const double* const* lines, const double* half, const Constants& constants, int n, double* ssim);

/// For tests: the supported instruction sets, and the choice of one (0: the best).
std::vector<int64_t> SimdTargets();
void ForceSimdTarget(int64_t target);

}  // namespace bodyloom::ssim_internal
