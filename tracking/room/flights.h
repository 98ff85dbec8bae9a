// SPDX-License-Identifier: Apache-2.0
/// Tells the person's stature by jumps: in flight the centre of mass falls with g = 9.81 m/s².
///
/// A single camera measures lengths in units of the assumed stature H₀, times in seconds. If a flight's parabola falls
/// with a, in metres of that size, the person is H = s H₀ tall, and s times as far away, with s = g / a. Each flight
/// gives
///   log s_k = log(g / a_k),   σ_k² = kFlightSigma² + (8 δ / (g L_k²))²
/// L_k: its length without the ends; 8 δ / L²: error of a when errors of δ = kCentreSigmaM bend the path over it;
/// kFlightSigma: what the pose in flight is off. Their robust mean (Geman–McClure, c = kFlightKernel, started at the
/// median) has the variance max(1, χ²/(n − 1)) / Σ w_k + kCommonSigma²; kCommonSigma: errors that all flights of a clip
/// share. The figures are of AIST++ and synthetic jumps (docs/lab/world.md).
///
/// A flight is a stretch of frames of one shot, all tracked, whose lowest point is more than kClearM above the ground,
/// between two frames where it is not. Its parabola is fitted by least squares without kFlightEnds of it at either end,
/// where heights of the ground matter. It counts if it has kMinFlight_s and five frames without the ends, and
/// kMaxFlight_s at most with them, if
///   the trunk is within kMaxTrunkLean of upright (the centre of mass of a rolled up body is less known),
///   the lowest point has not sunk below the ground by kSunkM in the second before or after (a trampoline),
///   and kMinFlightScale ≤ s ≤ kMaxFlightScale. Whatever else holds a body up, a rope, a partner, a ground at a wrong
/// height, makes s larger. Who is so much taller than assumed is not flying.
#pragma once

#include <span>
#include <vector>

#include "geometry/scene/track.h"
#include "tracking/problem/sequence_problem.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

inline constexpr double kClearM = 0.06, kSunkM = 0.06;
inline constexpr double kFlightEnds = 0.1;  ///< share
inline constexpr double kMinFlight_s = 0.15, kMaxFlight_s = 1;
inline constexpr double kMaxTrunkLean = 0.785;  ///< radians
inline constexpr double kMinFlightScale = 0.5, kMaxFlightScale = 1.25;
inline constexpr double kFlightSigma = 0.04, kCommonSigma = 0.04, kCentreSigmaM = 0.0043;
inline constexpr double kFlightKernel = 2.5;

/// The body in one frame, in metres of the assumed size. NaN: not known.
struct FlightFrame {
  double centre_m = 0;    ///< height of the centre of mass
  double lowest_m = 0;    ///< of the lowest point over the ground
  double trunk_lean = 0;  ///< angle of pelvis to neck against the vertical, radians
};

/// `frames`, `timestamps` (seconds) and `cut_before` of one length, checked. Without a flight, `flights` is 0 and `why`
/// tells the reason.
FlightSummary StatureFromFlights(std::span<const FlightFrame> frames, std::span<const double> timestamps,
                                 const std::vector<char>& cut_before, double assumed_stature_m);

/// The same of a solution and its track, with the stature of its body as the assumed one. Not of a camera that moves,
/// nor of several: their places tell the size.
FlightSummary StatureFromFlights(const SequenceProblem& problem, const Track& track, int num_threads);

}  // namespace bodyloom
